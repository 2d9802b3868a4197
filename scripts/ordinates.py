"""A preset's air as PythonicDISORT takes it: layers with optical depth, single-scattering albedo and phase moments.

All is made from what `tyndall presets show --json` prints: profiles are integrated here by closed forms, phase
functions by a Gauss rule on each piece of their tables, so that no number of the solver under test is used but
scattering and absorption per metre, and these are held against the optical depths that it states.
"""

import warnings

import numpy as np

# Scattering without loss is out of reach of discrete ordinates; so near it the light changes by less than 1e-5.
LOSSLESS = 1 - 1e-8


def spectrum(table, nm):
    """Linear between wavelengths, held beyond them; a single value where no wavelengths are."""
    return np.interp(nm, table["wavelengths_nm"], table["values"]) if table["wavelengths_nm"] else table["values"][0]


def phase_table(law, nm):
    """Nodes (cosines, 1/sr) between which the phase function is linear, not normalised."""
    nodes, rows = np.array(law["wavelengths_nm"]), np.array(law["rows"])
    k = int(np.clip(np.searchsorted(nodes, nm) - 1, 0, max(len(nodes) - 2, 0)))
    if len(nodes) == 1 or nm <= nodes[0]:
        return np.array(law["cosines"]), rows[0]
    share = min((nm - nodes[k]) / (nodes[k + 1] - nodes[k]), 1.0)
    return np.array(law["cosines"]), (1 - share) * rows[k] + share * rows[k + 1]


def moments(law, nm, count):
    """Legendre moments 0 .. count - 1 of a phase law, the first of them 1."""
    out = np.zeros(count)
    out[0] = 1.0
    if law["kind"] == "isotropic":
        return out
    if law["kind"] == "rayleigh":
        king = spectrum(law["king_factor"]["spectrum"], nm)
        delta = 6 * (king - 1) / (3 + 7 * king)
        # p = 1 + (1 - delta) / (2 + delta) P2 (Chandrasekhar's Rayleigh scattering with depolarisation delta).
        out[2] = (1 - delta) / (2 + delta) / 5
        return out
    if law["kind"] != "tabulated":
        raise SystemExit(f"no phase function {law['kind']} here")
    cosines, values = phase_table(law, nm)
    # A piece is short: its polynomials wave at most count * (angle across) / pi times.
    x, w = np.polynomial.legendre.leggauss(count // 4 + 8)
    middle, half = 0.5 * (cosines[1:] + cosines[:-1]), 0.5 * np.diff(cosines)
    nodes = (middle[:, None] + half[:, None] * x).ravel()
    weighted = (half[:, None] * w).ravel() * np.interp(nodes, cosines, values)
    before, now = np.ones_like(nodes), nodes
    out[0], out[1] = weighted.sum(), weighted @ now
    for l in range(2, count):
        before, now = now, ((2 * l - 1) * nodes * now - (l - 1) * before) / l
        out[l] = weighted @ now
    return out / out[0]


def column(profile, low, high):
    """Integral of a relative density over altitude between two of its nodes or within one of its pieces, m."""
    altitudes, densities = np.array(profile["nodes"]).T
    middle = 0.5 * (low + high)
    if not altitudes[0] < middle < altitudes[-1]:
        return 0.0
    if profile["kind"] == "linear":
        return np.interp(middle, altitudes, densities) * (high - low)
    if profile["kind"] != "log_linear":
        raise SystemExit(f"no profile {profile['kind']} here")
    a, b = np.exp(np.interp([low, high], altitudes, np.log(densities)))
    return (high - low) * (a if a == b else (b - a) / np.log(b / a))


class Air:
    """Layers from the top down at one wavelength, `parts` for each stretch between bends of any profile."""

    def __init__(self, report, w, altitudes, parts, count):
        planet, physics = report["preset"], report["physics"]
        nm, parted = physics["wavelengths_nm"][w], physics["constituents"]
        top = planet["top_radius_m"] - planet["ground_radius_m"]
        bends = {0.0, top, *altitudes}
        bends |= {n[0] for c in planet["constituents"] for n in c["profile"]["nodes"] if 0 < n[0] < top}
        # 64379.99999999999 beside 64380 is no layer.
        bends = sorted({round(z, 3) for z in bends})
        self.edges = np.array([a + (b - a) * k / parts for a, b in zip(bends, bends[1:]) for k in range(parts)] + [top])
        scattering, extinction = [], np.zeros(len(self.edges) - 1)
        laws = []
        for constituent, stated in zip(planet["constituents"], parted):
            if not constituent["density_factor"] > 0:
                continue
            profile = constituent["profile"]
            columns = np.array([column(profile, a, b) for a, b in zip(self.edges, self.edges[1:])])
            total = columns.sum()
            # What the command states is of the whole column; the profile spreads it over the layers.
            off = abs(total / stated["column_m"] - 1)
            if off > 1e-3:
                raise SystemExit(f"{constituent['name']}: a column {100 * off:.2f} % off the stated one")
            scattered = columns / total * stated["optical_depth_scattering"][w]
            scattering.append(scattered)
            laws.append(moments(constituent["phase"], nm, count))
            extinction += scattered + columns / total * stated["optical_depth_absorption"][w]
        scattering, laws = np.array(scattering)[:, ::-1], np.array(laws)
        extinction = extinction[::-1]
        both = scattering.sum(axis=0)
        self.depths = np.cumsum(extinction)
        self.albedos = np.minimum(both / extinction, LOSSLESS)
        self.moments = (scattering / both).T @ laws
        self.moments[:, 0] = 1.0
        self.ground = physics["ground_albedo"][w]
        # Optical depth at each edge, from the ground up.
        self.above = np.append(0.0, self.depths)[::-1]

    def depth(self, altitude):
        """Optical depth over an altitude that is an edge."""
        return self.above[np.argmin(abs(self.edges - altitude))]

    def light(self, mu0, streams, kept=None):
        """Quadrature cosines (upwards positive) and radiance there, per irradiance normal to the beam, over optical
        depth and azimuth (rad from where the light goes). The solution keeps as many moments as it has streams, or
        `kept`; light scattered once, and twice about the beam, has all (Nakajima & Tanaka 1988)."""
        from PythonicDISORT.pydisort import pydisort
        kept = kept or streams
        with warnings.catch_warnings():
            # It warns of albedos near 1: see LOSSLESS.
            warnings.simplefilter("ignore")
            mu, *_, radiance = pydisort(self.depths, self.albedos, streams, self.moments, mu0, 1.0, 0.0, NLeg=kept,
                                        NFourier=kept, f_arr=np.maximum(self.moments[:, kept], 0.0), NT_cor=True,
                                        BDRF_Fourier_modes=[self.ground])
        return mu, radiance
