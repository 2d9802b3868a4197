"""What runs look-ups: Vulkan by wgpu, OpenGL by moderngl, three.js in Chromium."""

import base64
import json
import shutil
from pathlib import Path

import numpy as np

from browsing import answer_of, install_chromium
from installing import three
from lookups import ANSWERS, FILTERING, VIEWS, glsl, hlsl_to, wgsl

HERE = Path(__file__).resolve().parent
VERTEX = "#version {}\nvoid main() {{ gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }}\n"


class Wgpu:
    """Compute shaders on Vulkan: WGSL as it is, HLSL as SPIR-V."""

    def __init__(self):
        import wgpu

        self.wgpu = wgpu
        adapter = wgpu.gpu.request_adapter_sync()
        self.device = adapter.request_device_sync()
        self.about = f"wgpu {wgpu.__version__}, {adapter.info['device']}"

    def run(self, lookup, by_hand, views):
        if lookup.language == "wgsl":
            code = wgsl(lookup, by_hand)
        else:
            shifts = ["-fvk-u-shift", str(ANSWERS), "0", "-fvk-s-shift", str(FILTERING), "0"]
            code = hlsl_to(lookup, by_hand, "-spirv", *shifts)
        usage, device = self.wgpu.BufferUsage, self.device
        count = lookup.count
        asked = device.create_buffer_with_data(data=views, usage=usage.STORAGE)
        answers = device.create_buffer(size=count * views.nbytes, usage=usage.STORAGE | usage.COPY_SRC)
        linear = device.create_sampler(mag_filter="linear", min_filter="linear")
        bound = {k: self.texture(*table[1:]) for k, table in enumerate(lookup.tables)}
        bound[FILTERING] = linear
        for k, buffer in ((VIEWS, asked), (ANSWERS, answers)):
            bound[k] = {"buffer": buffer, "offset": 0, "size": buffer.size}
        layout = device.create_bind_group_layout(entries=self.entries(lookup))
        whole = device.create_pipeline_layout(bind_group_layouts=[layout])
        module = device.create_shader_module(code=code)
        pipeline = device.create_compute_pipeline(layout=whole, compute={"module": module, "entry_point": "main"})
        bound = [{"binding": k, "resource": resource} for k, resource in bound.items()]
        group = device.create_bind_group(layout=layout, entries=bound)
        encoder = device.create_command_encoder()
        work = encoder.begin_compute_pass()
        work.set_pipeline(pipeline)
        work.set_bind_group(0, group)
        work.dispatch_workgroups(len(views))
        work.end()
        device.queue.submit([encoder.finish()])
        found = np.frombuffer(device.queue.read_buffer(answers), np.float32)
        return found.reshape(len(views), count, 4).transpose(1, 0, 2)

    def entries(self, lookup):
        stage = self.wgpu.ShaderStage.COMPUTE
        entries = [
            {"binding": k, "visibility": stage, "texture": {"view_dimension": f"{len(sizes)}d"}}
            for k, (_, sizes, _) in enumerate(lookup.tables)
        ]
        for binding, kind in ((VIEWS, "read-only-storage"), (ANSWERS, "storage")):
            entries.append({"binding": binding, "visibility": stage, "buffer": {"type": kind}})
        return entries + [{"binding": FILTERING, "visibility": stage, "sampler": {"type": "filtering"}}]

    def texture(self, sizes, texels):
        usage = self.wgpu.TextureUsage
        texture = self.device.create_texture(
            size=sizes, dimension=f"{len(sizes)}d", format="rgba16float", usage=usage.TEXTURE_BINDING | usage.COPY_DST)
        rows = {"bytes_per_row": 8 * sizes[0], "rows_per_image": sizes[1]}
        self.device.queue.write_texture({"texture": texture}, texels, rows, sizes)
        return texture.create_view()


class OpenGl:
    """Fragment shaders in OpenGL 4.5, whose drivers take those of OpenGL ES 3.0 too."""

    def __init__(self):
        import moderngl

        self.context = moderngl.create_context(standalone=True, backend="egl", require=450)
        self.context.disable(moderngl.BLEND)
        self.about = f"moderngl {moderngl.__version__}, {self.context.info['GL_RENDERER']}"
        self.linear = (moderngl.LINEAR, moderngl.LINEAR)

    def run(self, lookup, by_hand, views, version):
        context, count = self.context, lookup.count
        program = context.program(VERTEX.format(version), glsl(lookup, by_hand, version))
        held = [(name, self.texture(sizes, texels)) for name, sizes, texels in lookup.tables]
        held.append(("views", context.texture((len(views), 1), 4, views.tobytes(), dtype="f4")))
        for k, (name, texture) in enumerate(held):
            texture.use(k)
            # A table that no function of this bake reads is no uniform.
            if name in program:
                program[name] = k
        answers = context.texture((len(views), count), 4, dtype="f4")
        target = context.framebuffer([answers])
        target.use()
        context.vertex_array(program, []).render(vertices=3)
        found = np.frombuffer(answers.read(), np.float32).reshape(count, len(views), 4)
        for thing in (target, answers, program, *(t for _, t in held)):
            thing.release()
        return found

    def texture(self, sizes, texels):
        make = self.context.texture if len(sizes) == 2 else self.context.texture3d
        texture = make(tuple(sizes), 4, texels.tobytes(), dtype="f2")
        texture.filter = self.linear
        texture.repeat_x = texture.repeat_y = False
        if len(sizes) == 3:
            texture.repeat_z = False
        return texture


def drivers():
    """What runs each language, by its name."""
    found = {}
    try:
        gpu = Wgpu()
        found["WGSL, Vulkan"] = ("wgsl", lambda l, h, v: gpu.run(l, h, v))
        found["HLSL by dxc, Vulkan"] = ("hlsl", lambda l, h, v: gpu.run(l, h, v))
        print(gpu.about)
    except Exception as reason:
        print(f"left out: WGSL and HLSL are not run: {reason}")
    try:
        gl = OpenGl()
        found["GLSL 4.50, OpenGL"] = ("glsl", lambda l, h, v: gl.run(l, h, v, "450"))
        found["GLSL ES 3.00, OpenGL"] = ("glsl", lambda l, h, v: gl.run(l, h, v, "300 es"))
        print(gl.about)
    except Exception as reason:
        print(f"left out: GLSL is not run: {reason}")
    return found


class Page:
    """The sky dome of three-sky in three.js, in headless Chromium: WebGL2."""

    HOW = "GLSL ES 3.00, three.js in Chromium"

    def __init__(self, home, folder):
        self.site, self.asked = folder, []
        (folder / "node_modules").symlink_to(home / "node_modules")
        for file in ("index.html", "page.js", "sky.js"):
            shutil.copy(HERE / "three-sky" / file, folder)

    def ask(self, bake, layout, lookup, views, wanted):
        job = {"url": bake.name, "layout": layout, "views": views.ravel().tolist(), "calls": list(lookup.calls("vec4", "0.0"))}
        self.asked.append((job, bake.name, wanted))

    def answer(self, drawn, tally):
        """All questions at once, and the picture that the page draws of a bake."""
        job = {"asked": [job for job, _, _ in self.asked], "drawn": drawn.name}
        (self.site / "job.json").write_text(json.dumps(job))
        answer = answer_of(self.site)
        for (job, name, wanted), found in zip(self.asked, answer["answers"], strict=True):
            found = np.array(found, float).reshape(len(job["calls"]), -1, 4)
            tally.answered(f"{self.HOW}, {job['layout']}, filtered by texture unit", name, found, wanted)
        return base64.b64decode(answer["sheet"].split(",")[1])


def page(folder):
    """None, with a line, where there is no three.js or no Chromium."""
    home = three()
    refused = install_chromium() if home else None
    if refused:
        print(f"left out: three.js is not run: Chromium cannot be installed: {refused}")
    return None if refused or not home else Page(home, folder)
