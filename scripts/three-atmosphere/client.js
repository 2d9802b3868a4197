// A page that draws skies with the unmodified package @takram/three-atmosphere, as a game would: job.json in, the
// radiance that its shaders return (and, where a view has an exposure, a sheet of pictures) as JSON in <pre> out.

import { AtmosphereParameters, PrecomputedTexturesLoader, SkyMaterial } from "@takram/three-atmosphere";
import * as THREE from "three";

const job = await (await fetch("job.json")).json();
const renderer = new THREE.WebGLRenderer();
const answers = [];

function load(tables) {
  const loader = new PrecomputedTexturesLoader({
    combinedScattering: tables.combined,
    higherOrderScattering: false,
    type: THREE.HalfFloatType,
  });
  return new Promise((resolve, reject) => loader.load(tables.url, resolve, undefined, reject));
}

async function parametersOf(tables) {
  if (!tables.parameters) return AtmosphereParameters.DEFAULT;
  return new AtmosphereParameters(await (await fetch(tables.parameters)).json());
}

function sky(textures, atmosphere, view) {
  const albedo = view.ground ? atmosphere.groundAlbedo : { r: 0, g: 0, b: 0 };
  const material = new SkyMaterial({
    ...textures,
    correctAltitude: false,
    sun: view.ground,
    moon: false,
    ground: true,
    groundAlbedo: new THREE.Color(albedo.r, albedo.g, albedo.b),
    sunAngularRadius: atmosphere.sunAngularRadius,
  });
  // The material is made with the package's own Earth; another planet's parameters are its uniforms.
  material.uniforms.ATMOSPHERE = atmosphere.toUniform();
  material.uniforms.SUN_SPECTRAL_RADIANCE_TO_LUMINANCE.value = atmosphere.sunRadianceToRelativeLuminance;
  material.uniforms.SKY_SPECTRAL_RADIANCE_TO_LUMINANCE.value = atmosphere.skyRadianceToRelativeLuminance;
  material.sunDirection.set(Math.cos(view.sun), 0, Math.sin(view.sun));
  return material;
}

// Linear RGB of every pixel, from the bottom left, row by row.
function draw(textures, atmosphere, view) {
  const { width, height } = view;
  const target = new THREE.WebGLRenderTarget(width, height, { type: THREE.FloatType });
  const scene = new THREE.Scene();
  const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), sky(textures, atmosphere, view));
  quad.frustumCulled = false;
  scene.add(quad);
  const camera = new THREE.PerspectiveCamera(view.fov, width / height, 1, 1e8);
  camera.position.set(0, 0, atmosphere.bottomRadius + view.altitude);
  camera.up.set(...view.up);
  const [x, y, z] = view.look;
  camera.lookAt(x, y, z + camera.position.z);
  camera.updateMatrixWorld(true);
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = new Float32Array(width * height * 4);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  target.dispose();
  return Array.from(pixels).filter((_, k) => k % 4 < 3);
}

// Adds a picture to the sheet: a row for each set of tables, 1 - exp(-exposure x) and the curve of sRGB.
function print(sheet, pixels, view, column, row) {
  const { width, height } = view;
  const image = new ImageData(width, height);
  const encode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
  for (let n = 0; n < width * height; n++) {
    const to = (height - 1 - Math.floor(n / width)) * width + (n % width);
    for (let c = 0; c < 3; c++) {
      image.data[4 * to + c] = 255 * encode(1 - Math.exp(-view.exposure * Math.max(pixels[3 * n + c], 0)));
    }
    image.data[4 * to + 3] = 255;
  }
  sheet.getContext("2d").putImageData(image, column * width, row * height);
}

try {
  const [first] = job[0].views;
  const sheet = document.createElement("canvas");
  [sheet.width, sheet.height] = [first.width * job[0].views.length, first.height * job.length];
  for (const [row, tables] of job.entries()) {
    const [textures, atmosphere] = await Promise.all([load(tables), parametersOf(tables)]);
    const skies = tables.views.map((view) => draw(textures, atmosphere, view));
    const unit = atmosphere.skyRadianceToRelativeLuminance.toArray();
    const star = atmosphere.solarIrradiance.toArray();
    tables.views.forEach((view, column) => {
      if (view.exposure) print(sheet, skies[column], view, column, row);
    });
    answers.push({ name: tables.name, skies: first.exposure ? [] : skies, unit, star });
  }
  report({ answers, sheet: first.exposure ? sheet.toDataURL("image/png") : null });
} catch (error) {
  report({ error: String(error) });
}

function report(value) {
  const out = document.createElement("pre");
  out.id = "answers";
  out.textContent = JSON.stringify(value);
  document.body.append(out);
}
