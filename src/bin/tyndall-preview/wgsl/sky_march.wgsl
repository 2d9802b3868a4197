// What a frame asks of the air, answered without tables of scattering: the march of Nishita et al. 1993 along the view,
// light scattered once, with a second march towards the sun from every step or, after O'Neil 2004, a 2D table of
// optical depth (the bake's `transmittance`) in its place.

struct March {
    // Steps along the view, steps towards the sun (0: from the 2D table), groups of phase functions, texels of `air`.
    steps: vec4f,
}

@group(2) @binding(0) var<uniform> march: March;
// Coefficients at the four wavelengths, 1/km, over even altitudes from the ground to the top; a row for what each group
// scatters, then extinction.
@group(2) @binding(1) var air: texture_2d<f32>;

// Optical depth of the last ray that `scattered` marched.
var<private> marched: vec4f;

fn coefficient(altitude: f32, row: f32) -> vec4f {
    let size = vec2f(textureDimensions(air));
    let x = clamp(altitude / shell_height(tables.volume), 0.0, 1.0) * (size.x - 1.0);
    return 1e-3 * textureSampleLevel(air, filtering, (vec2f(x, row) + 0.5) / size, 0.0);
}

// Altitude after `s` along a ray.
fn altitude_along(altitude: f32, mu: f32, s: f32) -> f32 {
    let r = tables.volume.radii.x + altitude;
    let rise = s * (2.0 * r * mu + s);
    return altitude + rise / (sqrt(max(r * r + rise, 0.0)) + r);
}

fn depth_to_sun(altitude: f32, mu_s: f32) -> vec4f {
    let length = ray_length(tables.volume, altitude, mu_s, false);
    if march.steps.y < 0.5 {
        return depth_at(tables.depth, depth, filtering, place(tables.depth, altitude, mu_s, mu_s, 1.0, false, true));
    }
    let step = length / march.steps.y;
    var sum = vec4f(0.0);
    for (var k = 0.5; k < march.steps.y; k += 1.0) {
        sum += coefficient(altitude_along(altitude, mu_s, k * step), march.steps.z);
    }
    return sum * step;
}

fn sun_through_air(altitude: f32, mu_s: f32) -> vec4f {
    if hits_ground(tables.volume, altitude, mu_s) {
        return vec4f(0.0);
    }
    return exp(-depth_to_sun(altitude, mu_s));
}

fn scattered(p: Place, g: f32) -> vec3f {
    let r = tables.volume.radii.x + p.altitude;
    let step = ray_length(tables.volume, p.altitude, p.mu, p.hits_ground) / march.steps.x;
    var sums = array<vec4f, 3>();
    marched = vec4f(0.0);
    for (var k = 0.5; k < march.steps.x; k += 1.0) {
        let s = k * step;
        let altitude = altitude_along(p.altitude, p.mu, s);
        let mu_s = clamp((r * p.mu_s + s * p.nu) / (tables.volume.radii.x + altitude), -1.0, 1.0);
        let extinction = coefficient(altitude, march.steps.z) * step;
        let light = exp(-marched - 0.5 * extinction) * sun_through_air(max(altitude, 0.0), mu_s) * step;
        marched += extinction;
        sums[0] += light * coefficient(altitude, 0.0);
        if march.steps.z > 1.5 {
            sums[1] += light * coefficient(altitude, 1.0);
        }
        if march.steps.z > 2.5 {
            sums[2] += light * coefficient(altitude, 2.0);
        }
    }
    var light = vec4f(0.0);
    light += sums[0] * phase_at(tables.phase, phase, filtering, p.nu, 0.0);
    if march.steps.z > 1.5 {
        light += sums[1] * phase_at(tables.phase, phase, filtering, p.nu, 1.0);
    }
    if march.steps.z > 2.5 {
        light += sums[2] * phase_at(tables.phase, phase, filtering, p.nu, 2.0);
    }
    return rgb_of(tables, light);
}

fn scattered_here(p: Place, g: f32) -> vec3f {
    return scattered(p, g);
}

fn transmittance_of(p: Place) -> vec4f {
    return exp(-marched);
}

fn ground_after(mu_s: f32, through: vec4f) -> vec3f {
    let direct = sun_through_air(0.0, mu_s) * max(mu_s, 0.0);
    return rgb_of(tables, through * tables.ground_albedo / 3.14159265 * direct);
}

// Light of the sky along a ray, of which `kept` is left at the four wavelengths.
fn sky_after(p: Place, g: f32, kept: vec4f) -> vec3f {
    return scattered(p, g) * max(rgb_of(tables, kept) / rgb_of(tables, vec4f(1.0)), vec3f(0.0));
}
