"""Prisms with a wanted fan, and pairs of glasses without colour, by closed forms and Snell's law.

Angles are in radians; the lines are d, F and C, 587.6, 486.1 and 656.3 nm; indices are against air.
"""
import numpy as np

LINES = (587.5618, 486.1327, 656.2725)
SEEN = np.linspace(436, 656, 12)  # nm: where what is left of colour is looked for


def abbe_number(n):
    """V of the indices at d, F, C."""
    return (n[0] - 1) / (n[1] - n[2])


def least_deviation(apex, n):
    """Of a prism in air: the deviation at minimum deviation, and the angle of incidence there."""
    incidence = np.arcsin(n * np.sin(apex / 2))
    return 2 * incidence - apex, incidence


def apex_for(deviation, n):
    """The apex whose minimum deviation that is; nan where none deviates so far."""
    apex = 2 * np.arctan2(np.sin(deviation / 2), n - np.cos(deviation / 2))
    return apex if apex + deviation < np.pi else np.nan


def deviation_at(apex, n, incidence):
    """Of one prism; nan where the second face turns light back."""
    inside = apex - np.arcsin(np.sin(incidence) / n)
    with np.errstate(invalid="ignore"):
        return incidence + np.arcsin(n * np.sin(inside)) - apex


def spread_of(apex, n):
    """deviation(F) - deviation(C) where d is deviated least."""
    incidence = least_deviation(apex, n[0])[1]
    return deviation_at(apex, n[1], incidence) - deviation_at(apex, n[2], incidence)


def apex_for_spread(spread, n):
    """The apex that spreads F and C so far; nan where none does before light is turned back."""
    low, high = 0.0, 2 * np.arcsin(1 / n[0])
    for _ in range(60):
        apex = (low + high) / 2
        now = spread_of(apex, n)
        low, high = (apex, high) if now < spread else (low, apex)
    return apex if abs(spread_of(apex, n) - spread) < 1e-6 * spread else np.nan


def lens_pair(focal, first, second):
    """The focal lengths at d of two thin lenses in touch that bring F and C together at the focal
    length of d: f1 V1 + f2 V2 = 0 [BornWolf1999]."""
    v1, v2 = abbe_number(first), abbe_number(second)
    return focal * (v1 - v2) / v1, -focal * (v1 - v2) / v2


def pair_focal(focals, at_d, indices):
    """The pair's focal length where the indices are these: [..., 2] of the two glasses."""
    power = sum((n - 1) / ((d - 1) * f) for f, d, n in zip(focals, at_d, indices))
    return 1 / power


def pair_deviation(apexes, n1, n2):
    """Of two prisms that are cemented base to apex; light falls straight onto the first face. nan
    where a face turns it back."""
    last = apexes[0] - apexes[1]
    with np.errstate(invalid="ignore"):
        inside = np.arcsin(n1 / n2 * np.sin(apexes[0]))
        return -(last + np.arcsin(n2 * np.sin(apexes[0] - inside - last)))


def prism_pair(deviation, first, second):
    """The apexes that deviate d so far, and F and C alike; nan where there are none."""
    def wrong(apexes):
        at = [pair_deviation(apexes, a, b) for a, b in zip(first, second)]
        return np.array([at[0] - deviation, at[1] - at[2]])
    v1, v2 = abbe_number(first), abbe_number(second)
    apexes = deviation / (v1 - v2) * np.array([v1 / (first[0] - 1), v2 / (second[0] - 1)])
    for _ in range(20):
        now, step = wrong(apexes), 1e-7
        slopes = np.stack([(wrong(apexes + step * one) - now) / step for one in np.eye(2)], -1)
        if not np.all(np.isfinite(slopes)) or abs(np.linalg.det(slopes)) < 1e-12:
            return np.full(2, np.nan)
        apexes = apexes - np.linalg.solve(slopes, now)
    return apexes if np.abs(wrong(apexes)).max() < 1e-10 else np.full(2, np.nan)
