"""Problems of Hock and Schittkowski with six to sixteen variables; see `hock_schittkowski`."""

from __future__ import annotations

from math import asin, inf
from math import cos as cosine
from math import sin as sine
from math import sqrt as root

from .hock_schittkowski_medium import (
    COLVILLE_A,
    COLVILLE_B,
    COLVILLE_C,
    COLVILLE_D,
    COLVILLE_E,
    dot,
)
from .jets import cos, exp, log, sin
from .problem import at_least, between, equal, problem


@problem(
    start=(6e3, 1.5, 4e6, 2, 3e-3, 5e7),
    optimum=-0.9080747648,
    lower=(0, -10, 0, 0, -1, 0),
    upper=(2e4, 10, 1e7, 20, 1, 2e8),
)
def hs54(x1, x2, x3, x4, x5, x6):
    a, b = (x1 - 1e4) / 8e3, x2 - 1
    coupled = (a**2 + 0.4 * a * b + b**2) / 0.96
    rest = (x3 - 2e6) ** 2 / 4.9e13 + (x4 - 10) ** 2 / 2.5e3
    rest = rest + (x5 - 1e-3) ** 2 / 2.5e-3 + (x6 - 1e8) ** 2 / 2.5e17
    return -exp(-0.5 * (coupled + rest)), [equal(x1 + 4e3 * x2, 1.76e4)]


@problem(start=(1, 2, 0, 0, 0, 2), optimum=19 / 3, lower=0, upper=(1, inf, inf, 1, inf, inf))
def hs55(x1, x2, x3, x4, x5, x6):
    return x1 + 2 * x2 + 4 * x5 + exp(x1 * x4), [
        equal(x1 + 2 * x2 + 5 * x5, 6),
        equal(x1 + x2 + x3, 3),
        equal(x4 + x5 + x6, 2),
        equal(x1 + x4, 1),
        equal(x2 + x5, 2),
        equal(x3 + x6, 2),
    ]


@problem(start=(1, 1, 1, *[asin(root(1 / 4.2))] * 3, asin(root(5 / 7.2))), optimum=-3.456)
def hs56(x1, x2, x3, x4, x5, x6, x7):
    return -x1 * x2 * x3, [
        equal(x1 - 4.2 * sin(x4) ** 2, 0),
        equal(x2 - 4.2 * sin(x5) ** 2, 0),
        equal(x3 - 4.2 * sin(x6) ** 2, 0),
        equal(x1 + 2 * x2 + 2 * x3 - 7.2 * sin(x7) ** 2, 0),
    ]


@problem(start=(5.54, 4.4, 12.02, 11.82, 0.702, 0.852), optimum=135.075961, lower=0)
def hs93(x1, x2, x3, x4, x5, x6):
    primary, secondary = x1 * x4 * (x1 + x2 + x3), x2 * x3 * (x1 + 1.57 * x2 + x4)
    cost = primary * (0.0204 + 0.0607 * x5**2) + secondary * (0.0187 + 0.0437 * x6**2)
    return cost, [
        at_least(0.001 * x1 * x2 * x3 * x4 * x5 * x6, 2.07),
        at_least(1 - 0.00062 * primary * x5**2 - 0.00058 * secondary * x6**2, 0),
    ]


def refinery(b1, b2, b3, b4):
    """Hock and Schittkowski's 95 to 98 differ in their right hand sides."""

    def formula(x1, x2, x3, x4, x5, x6):
        cost = 4.3 * x1 + 31.8 * x2 + 63.3 * x3 + 15.8 * x4 + 68.5 * x5 + 4.7 * x6
        first = 17.1 * x1 + 38.2 * x2 + 204.2 * x3 + 212.3 * x4 + 623.4 * x5 + 1495.5 * x6
        first = first - 169 * x1 * x3 - 3580 * x3 * x5 - 3810 * x4 * x5
        first = first - 18500 * x4 * x6 - 24300 * x5 * x6
        second = 17.9 * x1 + 36.8 * x2 + 113.9 * x3 + 169.7 * x4 + 337.8 * x5 + 1385.2 * x6
        second = second - 139 * x1 * x3 - 2450 * x4 * x5 - 16600 * x4 * x6 - 17200 * x5 * x6
        third = -273 * x2 - 70 * x4 - 819 * x5 + 26000 * x4 * x5
        fourth = 159.9 * x1 - 311 * x2 + 587 * x4 + 391 * x5 + 2198 * x6 - 14000 * x1 * x6
        return cost, [
            at_least(first, b1),
            at_least(second, b2),
            at_least(third, b3),
            at_least(fourth, b4),
        ]

    return formula


TANKS = {"start": [0] * 6, "lower": 0, "upper": (0.31, 0.046, 0.068, 0.042, 0.028, 0.0134)}


@problem(**TANKS, optimum=0.015619514)
def hs95(*x):
    return refinery(4.97, -1.88, -29.08, -78.02)(*x)


@problem(**TANKS, optimum=0.015619514)
def hs96(*x):
    return refinery(4.97, -1.88, -69.08, -118.02)(*x)


@problem(**TANKS, optimum=3.1358091)
def hs97(*x):
    return refinery(32.97, 25.12, -29.08, -78.02)(*x)


@problem(**TANKS, optimum=3.1358091)
def hs98(*x):
    return refinery(32.97, 25.12, -124.08, -173.02)(*x)


@problem(start=[0.5] * 7, optimum=-831079891.6, lower=0, upper=1.58)
def hs99(*angles):
    times = (0, 25, 50, 100, 150, 200, 290, 380)
    thrusts = (50, 50, 75, 75, 75, 100, 100)
    height, climb, range_ = 0.0, 0.0, 0.0
    for angle, a, before, after in zip(angles, thrusts, times, times[1:], strict=False):
        t = after - before
        pull = a * sin(angle) - 32
        height = 0.5 * t**2 * pull + t * climb + height
        climb = t * pull + climb
        range_ = a * t * cos(angle) + range_
    return -(range_**2), [equal(height, 1e5), equal(climb, 1e3)]


@problem(start=(1, 2, 0, 4, 0, 1, 1), optimum=680.6300573)
def hs100(x1, x2, x3, x4, x5, x6, x7):
    f = (x1 - 10) ** 2 + 5 * (x2 - 12) ** 2 + x3**4 + 3 * (x4 - 11) ** 2 + 10 * x5**6
    f = f + 7 * x6**2 + x7**4 - 4 * x6 * x7 - 10 * x6 - 8 * x7
    return f, [
        at_least(127 - 2 * x1**2 - 3 * x2**4 - x3 - 4 * x4**2 - 5 * x5, 0),
        at_least(282 - 7 * x1 - 3 * x2 - 10 * x3**2 - x4 + x5, 0),
        at_least(196 - 23 * x1 - x2**2 - 6 * x6**2 + 8 * x7, 0),
        at_least(-4 * x1**2 - x2**2 + 3 * x1 * x2 - 2 * x3**2 - 5 * x6 + 11 * x7, 0),
    ]


def geometric(a):
    """Hock and Schittkowski's 101 to 103 differ in one exponent."""

    def formula(x1, x2, x3, x4, x5, x6, x7):
        f = 10 * x1 * x4**2 * x7**a / (x2 * x6**3) + 15 * x3 * x4 / (x1 * x2**2 * x5 * x7**0.5)
        f = (
            f
            + 20 * x2 * x6 / (x1**2 * x4 * x5**2)
            + 25 * x1**2 * x2**2 * x5**0.5 * x7 / (x3 * x6**2)
        )
        g1 = 0.5 * x1**0.5 * x7 / (x3 * x6**2) + 0.7 * x1**3 * x2 * x6 * x7**0.5 / x3**2
        g1 = g1 + 0.2 * x3 * x6 ** (2 / 3) * x7**0.25 / (x2 * x4**0.5)
        g2 = 1.3 * x2 * x6 / (x1**0.5 * x3 * x5) + 0.8 * x3 * x6**2 / (x4 * x5)
        g2 = g2 + 3.1 * x2**0.5 * x6 ** (1 / 3) / (x1 * x4**2 * x5)
        g3 = 2 * x1 * x5 * x7 ** (1 / 3) / (x3**1.5 * x6) + 0.1 * x2 * x5 / (x3**0.5 * x6 * x7**0.5)
        g3 = g3 + x2 * x3**0.5 * x5 / x1 + 0.65 * x3 * x5 * x7 / (x2**2 * x6)
        g4 = 0.2 * x2 * x5**0.5 * x7 ** (1 / 3) / (x1**2 * x4)
        g4 = g4 + 0.3 * x1**0.5 * x2**2 * x3 * x4 ** (1 / 3) * x7**0.25 / x5 ** (2 / 3)
        g4 = g4 + 0.4 * x3 * x5 * x7**0.75 / (x1**3 * x2**2) + 0.5 * x4 * x7**0.5 / x3**2
        return f, [*(at_least(1 - g, 0) for g in (g1, g2, g3, g4)), between(f, 100, 3000)]

    return formula


SEVEN = {"start": [6] * 7, "lower": (*[0.1] * 6, 0.01), "upper": 10}


@problem(**SEVEN, optimum=1809.76476)
def hs101(*x):
    return geometric(-0.25)(*x)


@problem(**SEVEN, optimum=911.880571)
def hs102(*x):
    return geometric(0.125)(*x)


@problem(**SEVEN, optimum=543.667958)
def hs103(*x):
    return geometric(0.5)(*x)


@problem(start=(6, 3, 0.4, 0.2, 6, 6, 1, 0.5), optimum=3.9511634396, lower=0.1, upper=10)
def hs104(x1, x2, x3, x4, x5, x6, x7, x8):
    f = 0.4 * x1**0.67 * x7**-0.67 + 0.4 * x2**0.67 * x8**-0.67 + 10 - x1 - x2
    return f, [
        at_least(1 - 0.0588 * x5 * x7 - 0.1 * x1, 0),
        at_least(1 - 0.0588 * x6 * x8 - 0.1 * x1 - 0.1 * x2, 0),
        at_least(1 - 4 * x3 / x5 - 2 * x3**-0.71 / x5 - 0.0588 * x3**-1.3 * x7, 0),
        at_least(1 - 4 * x4 / x6 - 2 * x4**-0.71 / x6 - 0.0588 * x4**-1.3 * x8, 0),
        between(f, 1, 4.2),
    ]


@problem(
    start=(5000, 5000, 5000, 200, 350, 150, 225, 425),
    optimum=7049.248020525,
    lower=(100, 1000, 1000, *[10] * 5),
    upper=(*[10000] * 3, *[1000] * 5),
)
def hs106(x1, x2, x3, x4, x5, x6, x7, x8):
    return x1 + x2 + x3, [
        at_least(1 - 0.0025 * (x4 + x6), 0),
        at_least(1 - 0.0025 * (x5 + x7 - x4), 0),
        at_least(1 - 0.01 * (x8 - x5), 0),
        at_least(x1 * x6 - 833.33252 * x4 - 100 * x1 + 83333.333, 0),
        at_least(x2 * x7 - 1250 * x5 - x2 * x4 + 1250 * x4, 0),
        at_least(x3 * x8 - 1250000 - x3 * x5 + 2500 * x5, 0),
    ]


@problem(
    start=(0.8, 0.8, 0.2, 0.2, 1.0454, 1.0454, 1.0454, 0, 0),
    optimum=5055.011803,
    lower=(0, 0, -inf, -inf, *[0.90909] * 3, -inf, -inf),
    upper=(*[inf] * 4, *[1.0909] * 3, inf, inf),
)
def hs107(x1, x2, x3, x4, x5, x6, x7, x8, x9):
    c, d = 48.4 / 50.176 * sine(0.25), 48.4 / 50.176 * cosine(0.25)
    s8, c8, s9, c9 = sin(x8), cos(x8), sin(x9), cos(x9)
    s, k = sin(x8 - x9), cos(x8 - x9)
    c2, d2 = 2 * c, 2 * d
    return 3000 * x1 + 1000 * x1**3 + 2000 * x2 + 666.667 * x2**3, [
        equal(0.4 - x1 + c2 * x5**2 - x5 * (x6 * (d * s8 + c * c8) + x7 * (d * s9 + c * c9)), 0),
        equal(0.4 - x2 + c2 * x6**2 + x6 * (x5 * (d * s8 - c * c8) + x7 * (d * s - c * k)), 0),
        equal(0.8 + c2 * x7**2 + x7 * (x5 * (d * s9 - c * c9) - x6 * (d * s + c * k)), 0),
        equal(0.2 - x3 + d2 * x5**2 + x5 * (x6 * (c * s8 - d * c8) + x7 * (c * s9 - d * c9)), 0),
        equal(0.2 - x4 + d2 * x6**2 - x6 * (x5 * (c * s8 + d * c8) + x7 * (c * s + d * k)), 0),
        equal(-0.337 + d2 * x7**2 - x7 * (x5 * (c * s9 + d * c9) - x6 * (c * s - d * k)), 0),
    ]


@problem(start=[1] * 9, optimum=-root(3) / 2, lower=(*[-inf] * 8, 0))
def hs108(x1, x2, x3, x4, x5, x6, x7, x8, x9):
    return -0.5 * (x1 * x4 - x2 * x3 + x3 * x9 - x5 * x9 + x5 * x8 - x6 * x7), [
        at_least(1 - x3**2 - x4**2, 0),
        at_least(1 - x9**2, 0),
        at_least(1 - x5**2 - x6**2, 0),
        at_least(1 - x1**2 - (x2 - x9) ** 2, 0),
        at_least(1 - (x1 - x5) ** 2 - (x2 - x6) ** 2, 0),
        at_least(1 - (x1 - x7) ** 2 - (x2 - x8) ** 2, 0),
        at_least(1 - (x3 - x5) ** 2 - (x4 - x6) ** 2, 0),
        at_least(1 - (x3 - x7) ** 2 - (x4 - x8) ** 2, 0),
        at_least(1 - x7**2 - (x8 - x9) ** 2, 0),
        at_least(x1 * x4 - x2 * x3, 0),
        at_least(x3 * x9, 0),
        at_least(-x5 * x9, 0),
        at_least(x5 * x8 - x6 * x7, 0),
    ]


@problem(
    start=[0] * 9,
    optimum=5326.851310,
    lower=(0, 0, -0.55, -0.55, 196, 196, 196, -400, -400),
    upper=(inf, inf, 0.55, 0.55, 252, 252, 252, 800, 800),
)
def hs109(x1, x2, x3, x4, x5, x6, x7, x8, x9):
    a, b, c = 50.176, sine(0.25), cosine(0.25)
    q = 0.7533e-3 * a

    def flow(of, angle, left, right):
        return left * right * of(angle - 0.25)

    return 3 * x1 + 1e-6 * x1**3 + 2 * x2 + 0.522074e-6 * x2**3, [
        between(x4 - x3, -0.55, 0.55),
        at_least(2250000 - x1**2 - x8**2, 0),
        at_least(2250000 - x2**2 - x9**2, 0),
        equal(
            flow(sin, -x3, x5, x6) + flow(sin, -x4, x5, x7) + 2 * b * x5**2 - a * x1 + 400 * a, 0
        ),
        equal(
            flow(sin, x3, x5, x6) + flow(sin, x3 - x4, x6, x7) + 2 * b * x6**2 - a * x2 + 400 * a,
            0,
        ),
        equal(flow(sin, x4, x5, x7) + flow(sin, x4 - x3, x6, x7) + 2 * b * x7**2 + 881.779 * a, 0),
        equal(
            a * x8
            + flow(cos, -x3, x5, x6)
            + flow(cos, -x4, x5, x7)
            + (q - 2 * c) * x5**2
            - 200 * a,
            0,
        ),
        equal(
            a * x9
            + flow(cos, x3, x5, x6)
            + flow(cos, x3 - x4, x6, x7)
            + (q - 2 * c) * x6**2
            - 200 * a,
            0,
        ),
        equal(
            flow(cos, x4, x5, x7) + flow(cos, x4 - x3, x6, x7) + (q - 2 * c) * x7**2 + 22.938 * a,
            0,
        ),
    ]


@problem(start=[9] * 10, optimum=-45.77846971, lower=2.001, upper=9.999)
def hs110(*x):
    product = 1.0
    for v in x:
        product = product * v
    return sum(log(v - 2) ** 2 + log(10 - v) ** 2 for v in x) - product**0.2, []


ENERGIES = (-6.089, -17.164, -34.054, -5.914, -24.721, -14.986, -24.1, -10.708, -26.662, -22.179)


def balances(x):
    """Hydrogen, nitrogen and oxygen in the ten compounds."""
    x1, x2, x3, x4, x5, x6, x7, x8, x9, x10 = x
    return [
        equal(x1 + 2 * x2 + 2 * x3 + x6 + x10, 2),
        equal(x4 + 2 * x5 + x6 + x7, 1),
        equal(x3 + x7 + x8 + 2 * x9 + x10, 1),
    ]


@problem(start=[-2.3] * 10, optimum=-47.76109026, lower=-100, upper=100)
def hs111(*x):
    moles = [exp(v) for v in x]
    total = log(sum(moles))
    f = sum(m * (c + v - total) for m, c, v in zip(moles, ENERGIES, x, strict=True))
    return f, balances(moles)


@problem(start=[0.1] * 10, optimum=-47.76109026, lower=1e-6)
def hs112(*x):
    total = log(sum(x))
    return sum(v * (c + log(v) - total) for v, c in zip(x, ENERGIES, strict=True)), balances(x)


@problem(start=(2, 3, 5, 5, 1, 2, 7, 3, 6, 10), optimum=24.3062091)
def hs113(x1, x2, x3, x4, x5, x6, x7, x8, x9, x10):
    f = x1**2 + x2**2 + x1 * x2 - 14 * x1 - 16 * x2 + (x3 - 10) ** 2 + 4 * (x4 - 5) ** 2
    f = f + (x5 - 3) ** 2 + 2 * (x6 - 1) ** 2 + 5 * x7**2 + 7 * (x8 - 11) ** 2
    return f + 2 * (x9 - 10) ** 2 + (x10 - 7) ** 2 + 45, [
        at_least(105 - 4 * x1 - 5 * x2 + 3 * x7 - 9 * x8, 0),
        at_least(-10 * x1 + 8 * x2 + 17 * x7 - 2 * x8, 0),
        at_least(8 * x1 - 2 * x2 - 5 * x9 + 2 * x10 + 12, 0),
        at_least(-3 * (x1 - 2) ** 2 - 4 * (x2 - 3) ** 2 - 2 * x3**2 + 7 * x4 + 120, 0),
        at_least(-5 * x1**2 - 8 * x2 - (x3 - 6) ** 2 + 2 * x4 + 40, 0),
        at_least(-0.5 * (x1 - 8) ** 2 - 2 * (x2 - 4) ** 2 - 3 * x5**2 + x6 + 30, 0),
        at_least(-(x1**2) - 2 * (x2 - 2) ** 2 + 2 * x1 * x2 - 14 * x5 + 6 * x6, 0),
        at_least(3 * x1 - 6 * x2 - 12 * (x9 - 8) ** 2 + 7 * x10, 0),
    ]


@problem(
    start=(1745, 12000, 110, 3048, 1974, 89.2, 92.8, 8, 3.6, 145),
    optimum=-1768.80696,
    lower=(*[1e-5] * 5, 85, 90, 3, 1.2, 145),
    upper=(2000, 16000, 120, 5000, 2000, 93, 95, 12, 4, 162),
)
def hs114(x1, x2, x3, x4, x5, x6, x7, x8, x9, x10):
    a, b = 0.99, 0.9
    number = 35.82 - 0.222 * x10
    factor = 3 * x7 - 133
    alkylate = x1 * (1.12 + 0.13167 * x8 - 0.00667 * x8**2)
    octane = 57.425 + 1.098 * x8 - 0.038 * x8**2 + 0.325 * x6
    return 5.04 * x1 + 0.035 * x2 + 10 * x3 + 3.36 * x5 - 0.063 * x4 * x7, [
        at_least(number - b * x9, 0),
        at_least(factor - a * x10, 0),
        at_least(x9 / b - number, 0),
        at_least(x10 / a - factor, 0),
        at_least(alkylate - a * x4, 0),
        at_least(octane - a * x7, 0),
        at_least(x4 / a - alkylate, 0),
        at_least(x7 / a - octane, 0),
        equal(1.22 * x4 - x1 - x5, 0),
        equal(98000 * x3 / (x4 * x9 + 1000 * x3) - x6, 0),
        equal((x2 + x5) / x1 - x8, 0),
    ]


@problem(
    start=(0.5, 0.8, 0.9, 0.1, 0.14, 0.5, 489, 80, 650, 450, 150, 150, 150),
    optimum=97.587510,
    lower=(0.1, 0.1, 0.1, 1e-4, 0.1, 0.1, 0.1, 0.1, 500, 0.1, 1, 1e-4, 1e-4),
    upper=(1, 1, 1, 0.1, 0.9, 0.9, 1000, 1000, 1000, 500, 150, 150, 150),
)
def hs116(x1, x2, x3, x4, x5, x6, x7, x8, x9, x10, x11, x12, x13):
    def membrane(area, feed, concentration):
        return area - 1.262626 * feed + 1.231059 * concentration * feed

    def stage(left, right):
        return left - 0.03475 * right - 0.975 * right * left + 0.00975 * right**2

    return x11 + x12 + x13, [
        at_least(x3 - x2, 0),
        at_least(x2 - x1, 0),
        at_least(1 - 0.002 * (x7 - x8), 0),
        between(x11 + x12 + x13, 50, 250),
        at_least(membrane(x13, x10, x3), 0),
        at_least(membrane(x12, x9, x2), 0),
        at_least(membrane(x11, x8, x1), 0),
        at_least(stage(x5, x2), 0),
        at_least(stage(x6, x3), 0),
        at_least(stage(x4, x1), 0),
        at_least(x5 * x7 - x1 * x8 - x4 * x7 + x4 * x8, 0),
        at_least(1 - 0.002 * (x2 * x9 + x5 * x8 - x1 * x8 - x6 * x9) - x5 - x6, 0),
        at_least(x2 * x9 - x3 * x10 - x6 * x9 - 500 * x2 + 500 * x6 + x2 * x10, 0),
        at_least(x2 - 0.9 - 0.002 * (x2 * x10 - x3 * x10), 0),
    ]


@problem(start=[60 if i == 6 else 0.001 for i in range(15)], optimum=32.34867897, lower=0)
def hs117(*x):
    y, z = x[:10], x[10:]
    bent = [dot(row, z) for row in COLVILLE_C]
    f = sum(c * v for c, v in zip(bent, z, strict=True)) - dot(COLVILLE_B, y)
    f = f + 2 * dot(COLVILLE_D, [v**3 for v in z])
    return f, [
        at_least(
            2 * bent[j] + 3 * COLVILLE_D[j] * z[j] ** 2 + COLVILLE_E[j] - dot(COLVILLE_A[:, j], y),
            0,
        )
        for j in range(5)
    ]


@problem(
    start=(20, 55, 15, *[20, 60, 20] * 4),
    optimum=664.82045,
    lower=(8, 43, 3, *[0] * 12),
    upper=(21, 57, 16, *[90, 120, 60] * 4),
)
def hs118(*x):
    costs = ((2.3, 1e-4), (1.7, 1e-4), (2.2, 1.5e-4))
    f = sum(a * v + b * v**2 for (a, b), v in zip(costs * 5, x, strict=True))
    steps = [between(x[i + 3] - x[i], -7, 7 if i % 3 == 1 else 6) for i in range(12)]
    demands = zip((60, 50, 70, 85, 100), range(0, 15, 3), strict=True)
    return f, [*steps, *(at_least(x[i] + x[i + 1] + x[i + 2], d) for d, i in demands)]


# Which pairs (i, j) of variables, counted from 1, meet in the objective.
COLVILLE_PAIRS = {
    1: (1, 4, 7, 8, 16),
    2: (2, 3, 7, 10),
    3: (3, 7, 9, 10, 14),
    4: (4, 7, 11, 15),
    5: (5, 6, 10, 12, 16),
    6: (6, 8, 15),
    7: (7, 11, 13),
    8: (8, 10, 15),
    9: (9, 12, 16),
    10: (10, 14),
    11: (11, 13),
    12: (12, 14),
    13: (13, 14),
    14: (14,),
    15: (15,),
    16: (16,),
}
# The eight equalities: the first eight columns; after them stands the unit matrix.
COLVILLE_ROWS = (
    ((0.22, 0.20, 0.19, 0.25, 0.15, 0.11, 0.12, 0.13), 2.5),
    ((-1.46, 0, -1.30, 1.82, -1.15, 0, 0.80, 0), 1.1),
    ((1.29, -0.89, 0, 0, -1.16, -0.96, 0, -0.49), -3.1),
    ((-1.10, -1.06, 0.95, -0.54, 0, -1.78, -0.41, 0), -3.5),
    ((0, 0, 0, -1.43, 1.51, 0.59, -0.33, -0.43), 1.3),
    ((0, -1.72, -0.33, 0, 1.62, 1.24, 0.21, -0.26), 2.1),
    ((1.12, 0, 0, 0.31, 0, 0, 1.12, 0, -0.36), 2.3),
    ((0, 0.45, 0.26, -1.10, 0.58, 0, -1.03, 0.10), -1.5),
)


@problem(start=[10] * 16, optimum=244.899698, lower=0, upper=5)
def hs119(*x):
    p = [v**2 + v + 1 for v in x]
    f = sum(p[i - 1] * p[j - 1] for i, js in COLVILLE_PAIRS.items() for j in js)
    return f, [
        equal(dot(row, x[: len(row)]) + x[8 + k], target)
        for k, (row, target) in enumerate(COLVILLE_ROWS)
    ]
