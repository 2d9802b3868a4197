"""Look-up files of a bake, and their golden vectors: what scripts/validate-shaders compiles and runs."""

import csv
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

CALLS = {
    "compact": ["sky_radiance_at_four", "sky_total_at_four", "sky_radiance", "sky_total"],
    "elek2010": ["sky_radiance", "sky_total"],
}
FOUR = "sky_radiance_at_four", "sky_total_at_four"
# Where the HLSL has its views, and both kinds of compute shader their answers and sampler.
VIEWS, ANSWERS, FILTERING = 20, 21, 30


class Lookup:
    """A file of look-ups with the textures that its first comment lists, in their order."""

    def __init__(self, bake, layout, language):
        self.name, self.layout, self.language = f"{bake.name} {layout}", layout, language
        self.text = (bake / layout / f"lookup.{language}").read_text()
        self.count, self.tables = len(CALLS[layout]), []
        listed = re.findall(r"^// +(\d+)  (\w+) +([23])D  ([\dx ]+?) +(\S+\.exr)$", self.text, re.M)
        for k, (number, name, axes, size, file) in enumerate(listed):
            assert int(number) == k, number
            sizes = [int(n) for n in size.split(" x ")]
            held = np.load(bake / Path(file).with_suffix(".npy"), allow_pickle=False)
            texels = np.zeros((*sizes[::-1], 4), np.float16)
            texels[..., : held.shape[-1]] = held.reshape(*sizes[::-1], held.shape[-1])
            assert len(sizes) == int(axes), size
            self.tables.append((name, sizes, texels))
        assert self.tables, "no tables in the comment"

    def calls(self, vec4, zero):
        """For each function, an expression of its answer to the view `v` as four numbers."""
        for call in CALLS[self.layout]:
            asked = f"{call}(v.x, v.y, v.z, v.w)"
            yield asked if call in FOUR else f"{vec4}({asked}, {zero})"


def golden(bake, layout):
    """Views as shaders take them (altitude, mu, mu_s, nu), and for each function what it should answer."""
    manifest = json.loads((bake / "bake.json").read_text())
    with open(bake / layout / "vectors.csv") as file:
        header, *lines = csv.reader(file)
    rows = np.array(lines, float)
    altitude, mu, mu_s = rows[:, :3].astype(np.float32).astype(float).T
    sines = np.sqrt((1 - mu * mu) * (1 - mu_s * mu_s))
    nu = np.clip(mu * mu_s + sines * np.cos(np.radians(rows[:, 3])), -1, 1)
    views = np.stack([altitude, mu, mu_s, nu], axis=1).astype(np.float32)
    half = (len(header) - 4) // 2
    assert (rows[:, 4:] > 0).any(axis=1).sum() > len(rows) / 3, "most views see light"
    scattering, total = rows[:, 4 : 4 + half], rows[:, 4 + half :]
    if layout == "elek2010":
        return views, [scattering, total]
    matrix = np.array(manifest["colour"]["matrices"]["rgb_from_four"]).T
    lux = manifest["constants"]["star_illuminance_lx"][0]
    return views, [scattering, total, scattering @ matrix / lux, total @ matrix / lux]


def tool(*command):
    """Runs a compiler; what it says where it refuses."""
    done = subprocess.run([*map(str, command)], capture_output=True, text=True)
    return None if done.returncode == 0 else (done.stdout + done.stderr).strip()[:2000]


class Refused(Exception):
    pass


def hlsl(lookup, by_hand):
    count = lookup.count
    calls = "\n".join(f"    answers[{count} * id.x + {k}] = {c};" for k, c in enumerate(lookup.calls("float4", "0.0")))
    define = "#define HAND_FILTERED true\n" if by_hand else ""
    return define + lookup.text + f"""
StructuredBuffer<float4> views : register(t{VIEWS});
RWStructuredBuffer<float4> answers : register(u0);
[numthreads(1, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {{
    float4 v = views[id.x];
{calls}
}}
"""


def hlsl_to(lookup, by_hand, *options):
    """By dxc, of which an error ends the script."""
    with tempfile.TemporaryDirectory() as folder:
        source, made = Path(folder) / "source.hlsl", Path(folder) / "made"
        source.write_text(hlsl(lookup, by_hand))
        refused = tool(sys.executable, Path(__file__).parent / "dxc.py", source, made, "-T", "cs_6_0", "-E", "main", *options)
        if refused:
            raise Refused(refused)
        return made.read_bytes()


def glsl(lookup, by_hand, version):
    """A pixel for each view, a row for each function."""
    define = "#define HAND_FILTERED true\n" if by_hand else ""
    calls = "\n".join(f"    if (row == {k}) answer = {c};" for k, c in enumerate(lookup.calls("vec4", "0.0")))
    place = "layout(location = 0) "
    return f"#version {version}\n{define}{lookup.text}" + f"""
#ifdef VULKAN
layout(set = 1, binding = 0)
#endif
uniform highp sampler2D views;
{place}out vec4 answer;
void main() {{
    vec4 v = texelFetch(views, ivec2(int(gl_FragCoord.x), 0), 0);
    int row = int(gl_FragCoord.y);
{calls}
}}
"""


def wgsl(lookup, by_hand):
    """A compute shader that answers all views by all functions."""
    calls = [f"    answers[{lookup.count}u * id.x + {k}u] = {c};" for k, c in enumerate(lookup.calls("vec4f", "0.0"))]
    sampler = "@binding({}) var table_filtering"
    text = lookup.text.replace(sampler.format(len(lookup.tables)), sampler.format(FILTERING))
    text = text.replace("override HAND_FILTERED: bool = false", f"const HAND_FILTERED: bool = {str(by_hand).lower()}")
    return text + f"""
@group(0) @binding({VIEWS}) var<storage, read> views: array<vec4f>;
@group(0) @binding({ANSWERS}) var<storage, read_write> answers: array<vec4f>;
@compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id: vec3u) {{
    let v = views[id.x];
""" + "\n".join(calls) + "\n}\n"
