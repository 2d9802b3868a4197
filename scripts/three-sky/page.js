// Draws a bake's sky at four heights of the sun, and answers its golden views: what scripts/validate-shaders asks for.

import * as THREE from 'three';
import { dome, load } from './sky.js';

const [WIDTH, HEIGHT] = [480, 270];

function sky(renderer, lookups, degrees) {
  const angle = THREE.MathUtils.degToRad(degrees);
  const sun = new THREE.Vector3(0, Math.sin(angle), -Math.cos(angle));
  const camera = new THREE.PerspectiveCamera(70, WIDTH / HEIGHT, 0.1, 10);
  camera.lookAt(0, 0.35, -1);
  const scene = new THREE.Scene();
  // Exposed for the sky's own brightness, which falls by 300 from day to dusk.
  scene.add(dome(lookups, 2, sun, degrees > 0 ? 12 : 12 * 2 ** (-1.4 * degrees)));
  renderer.render(scene, camera);
}

// Four numbers for each view (altitude, mu, mu_s, nu) and each expression of GLSL in `v`.
function answers(renderer, { code, uniforms }, views, calls) {
  const count = views.length / 4;
  const held = new THREE.DataTexture(new Float32Array(views), count, 1, THREE.RGBAFormat, THREE.FloatType);
  held.needsUpdate = true;
  const rows = calls.map((call, k) => `if (row == ${k}) answer = ${call};`).join('\n');
  const material = new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    uniforms: { ...uniforms, views: { value: held } },
    vertexShader: 'void main() { gl_Position = vec4(position.xy * 2.0, 0.0, 1.0); }',
    fragmentShader: `${code}
      uniform highp sampler2D views;
      layout(location = 0) out highp vec4 answer;
      void main() {
        vec4 v = texelFetch(views, ivec2(int(gl_FragCoord.x), 0), 0);
        int row = int(gl_FragCoord.y);
        ${rows}
      }`,
  });
  const target = new THREE.WebGLRenderTarget(count, calls.length, { type: THREE.FloatType, depthBuffer: false });
  const scene = new THREE.Scene();
  const plane = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), material);
  plane.frustumCulled = false;
  scene.add(plane);
  renderer.setRenderTarget(target);
  renderer.render(scene, new THREE.Camera());
  const found = new Float32Array(4 * count * calls.length);
  renderer.readRenderTargetPixels(target, 0, 0, count, calls.length, found);
  renderer.setRenderTarget(null);
  return Array.from(found);
}

async function main() {
  const job = await (await fetch('job.json')).json();
  const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
  renderer.debug.onShaderError = (gl, program, vertex, fragment) => {
    throw new Error(gl.getShaderInfoLog(vertex) + gl.getShaderInfoLog(fragment));
  };
  renderer.setSize(WIDTH, HEIGHT);
  const out = { answers: [], about: 'WebGL2' };
  for (const { url, layout, views, calls } of job.asked) {
    out.answers.push(answers(renderer, await load(url, renderer, layout), views, calls));
  }
  const sheet = document.createElement('canvas');
  [sheet.width, sheet.height] = [2 * WIDTH, 2 * HEIGHT];
  const lookups = await load(job.drawn, renderer);
  [40, 8, 0.5, -5].forEach((degrees, k) => {
    sky(renderer, lookups, degrees);
    sheet.getContext('2d').drawImage(renderer.domElement, (k % 2) * WIDTH, (k >> 1) * HEIGHT);
  });
  out.sheet = sheet.toDataURL('image/png');
  return out;
}

const show = (answer) => {
  const pre = document.createElement('pre');
  pre.id = 'answers';
  pre.textContent = JSON.stringify(answer);
  document.body.append(pre);
};
main().then(show, (error) => show({ error: String(error.stack ?? error) }));
