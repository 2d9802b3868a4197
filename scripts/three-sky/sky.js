// A bake of the layout compact in plain three.js: its KTX2 files as textures, its lookup.glsl as the shader's own code.

import * as THREE from 'three';
import { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';

// The look-ups of a bake at `url` and the textures that their first comment names, as uniforms.
export async function load(url, renderer, layout = 'compact') {
  const code = await (await fetch(`${url}/${layout}/lookup.glsl`)).text();
  const loader = new KTX2Loader().detectSupport(renderer);
  const uniforms = {};
  for (const [, name, file] of code.matchAll(/^\/\/ +\d+  (\w+) .* (\S+)\.exr$/gm)) {
    const texture = await loader.loadAsync(`${url}/${file}.ktx2`);
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    uniforms[name] = { value: texture };
  }
  return { code, uniforms };
}

// A dome around the camera, `altitude` m over the ground, y up, with the sun in direction `sun` (a Vector3).
export function dome({ code, uniforms }, altitude, sun, exposure) {
  const material = new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    side: THREE.BackSide,
    depthWrite: false,
    uniforms: { ...uniforms, altitude: { value: altitude }, sun: { value: sun }, exposure: { value: exposure } },
    vertexShader: `
      out vec3 direction;
      void main() {
        direction = position;
        gl_Position = projectionMatrix * vec4(mat3(modelViewMatrix) * position, 1.0);
      }`,
    fragmentShader: `${code}
      uniform float altitude, exposure;
      uniform vec3 sun;
      in vec3 direction;
      layout(location = 0) out highp vec4 colour;
      void main() {
        vec3 view = normalize(direction);
        vec3 light = sky_total(altitude, view.y, sun.y, dot(view, sun));
        colour = vec4(1.0 - exp(-exposure * max(light, 0.0)), 1.0);
        colour = linearToOutputTexel(colour);
      }`,
  });
  return new THREE.Mesh(new THREE.SphereGeometry(1, 64, 32), material);
}
