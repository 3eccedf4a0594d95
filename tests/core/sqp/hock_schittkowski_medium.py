"""Problems of Hock and Schittkowski with two to five variables, from number 57 on; see
`hock_schittkowski`."""

from __future__ import annotations

from math import sqrt as root

import numpy as np

from .jets import erf, exp, log, sin, sqrt
from .problem import at_least, between, equal, problem

AGES = [8] * 2 + [10] * 4 + [12] * 4 + [14] * 3 + [16] * 3 + [18] * 2 + [20] * 3 + [22] * 3
AGES += [24] * 3 + [26] * 3 + [28] * 2 + [30] * 3 + [32] * 2 + [34] + [36] * 2 + [38] * 2 + [40, 42]
# fmt: off
CHLORINE = [
    49, 49, 48, 47, 48, 47, 46, 46, 45, 43, 45, 43, 43, 44, 43, 43, 46, 45, 42, 42, 43, 41,
    41, 40, 42, 40, 40, 41, 40, 41, 41, 40, 40, 40, 38, 41, 40, 40, 41, 38, 40, 40, 39, 39,
]
# fmt: on


@problem(start=(0.42, 5), optimum=0.02845966972, lower=(0.4, -4))
def hs57(x1, x2):
    modelled = [x1 + (0.49 - x1) * exp(-x2 * (age - 8)) for age in AGES]
    misfit = sum((0.01 * c - y) ** 2 for c, y in zip(CHLORINE, modelled, strict=True))
    return misfit, [at_least(0.49 * x2 - x1 * x2, 0.09)]


@problem(start=(90, 10), optimum=-7.80278948, lower=0, upper=(75, 65))
def hs59(x1, x2):
    of_x1 = 3.8112 * x1 - 0.12694 * x1**2 + 0.0020567 * x1**3 - 1.0345e-5 * x1**4
    of_x2 = 6.8306 * x2 - 0.25645 * x2**2 + 0.0034604 * x2**3 - 1.3514e-5 * x2**4
    linear = x2 * (-0.030234 * x1 + 1.28134e-3 * x1**2 - 3.5256e-5 * x1**3 + 2.266e-7 * x1**4)
    square = x2**2 * (-3.405e-4 * x1 + 5.2375e-6 * x1**2 + 6.3e-8 * x1**3)
    cubic = x2**3 * (1.6638e-6 * x1 - 7e-10 * x1**3)
    rest = 28.106 / (x2 + 1) + 2.8673 * exp(0.0005 * x1 * x2) - 75.196
    return of_x1 + of_x2 + linear + square + cubic + rest, [
        at_least(x1 * x2, 700),
        at_least(x2 - x1**2 / 125, 0),
        at_least((x2 - 50) ** 2 - 5 * (x1 - 55), 0),
    ]


@problem(start=(2, 2, 2), optimum=0.03256820025, lower=-10, upper=10)
def hs60(x1, x2, x3):
    return (x1 - 1) ** 2 + (x1 - x2) ** 2 + (x2 - x3) ** 4, [
        equal(x1 * (1 + x2**2) + x3**4, 4 + 3 * root(2))
    ]


@problem(start=(0, 0, 0), optimum=-143.6461422)
def hs61(x1, x2, x3):
    return 4 * x1**2 + 2 * x2**2 + 2 * x3**2 - 33 * x1 + 16 * x2 - 24 * x3, [
        equal(3 * x1 - 2 * x2**2, 7),
        equal(4 * x1 - x3**2, 11),
    ]


@problem(start=(0.7, 0.2, 0.1), optimum=-26272.51448, lower=0, upper=1)
def hs62(x1, x2, x3):
    three, two, one = x1 + x2 + x3 + 0.03, x2 + x3 + 0.03, x3 + 0.03
    total = 255 * log(three / (0.09 * x1 + two)) + 280 * log(two / (0.07 * x2 + one))
    return -32.174 * (total + 290 * log(one / (0.13 * x3 + 0.03))), [equal(x1 + x2 + x3, 1)]


@problem(start=(2, 2, 2), optimum=961.7151721, lower=0)
def hs63(x1, x2, x3):
    return 1000 - x1**2 - 2 * x2**2 - x3**2 - x1 * x2 - x1 * x3, [
        equal(8 * x1 + 14 * x2 + 7 * x3, 56),
        equal(x1**2 + x2**2 + x3**2, 25),
    ]


@problem(start=(1, 1, 1), optimum=6299.842428, lower=1e-5)
def hs64(x1, x2, x3):
    return 5 * x1 + 5e4 / x1 + 20 * x2 + 7.2e4 / x2 + 10 * x3 + 14.4e4 / x3, [
        at_least(1 - 4 / x1 - 32 / x2 - 120 / x3, 0)
    ]


@problem(start=(-5, 5, 0), optimum=0.9535288567, lower=(-4.5, -4.5, -5), upper=(4.5, 4.5, 5))
def hs65(x1, x2, x3):
    return (x1 - x2) ** 2 + (x1 + x2 - 10) ** 2 / 9 + (x3 - 5) ** 2, [
        at_least(48 - x1**2 - x2**2 - x3**2, 0)
    ]


@problem(start=(0, 1.05, 2.9), optimum=0.5181632741, lower=0, upper=(100, 100, 10))
def hs66(x1, x2, x3):
    return 0.2 * x3 - 0.8 * x1, [at_least(x2 - exp(x1), 0), at_least(x3 - exp(x2), 0)]


def inspection(a, b, d, n):
    """The cost of a quality control chart, and its two equations."""

    def formula(x1, x2, x3, x4):
        grown = exp(x1) - 1
        cost = (a * n - (b * grown - x3) * x4 / (grown + x4)) / x1
        shifted = [0.5 * (1 + erf((-x2 + s * d * root(n)) / root(2))) for s in (1, -1)]
        return cost, [
            equal(x3 - (1 + erf(-x2 / root(2))), 0),
            equal(x4 - shifted[0] - shifted[1], 0),
        ]

    return formula


CHART = {"start": (1, 1, 1, 1), "lower": (1e-4, 0, 0, 0), "upper": (100, 100, 2, 2)}


@problem(**CHART, optimum=-0.920425026)
def hs68(*x):
    return inspection(0.0001, 1, 1, 24)(*x)


@problem(**CHART, optimum=-956.71288)
def hs69(*x):
    return inspection(0.1, 1000, 1, 4)(*x)


@problem(start=(1, 5, 5, 1), optimum=17.0140173, lower=1, upper=5)
def hs71(x1, x2, x3, x4):
    return x1 * x4 * (x1 + x2 + x3) + x3, [
        at_least(x1 * x2 * x3 * x4, 25),
        equal(x1**2 + x2**2 + x3**2 + x4**2, 40),
    ]


@problem(start=(1, 1, 1, 1), optimum=727.67937, lower=0.001, upper=(4e5, 3e5, 2e5, 1e5))
def hs72(x1, x2, x3, x4):
    return 1 + x1 + x2 + x3 + x4, [
        at_least(0.0401 - 4 / x1 - 2.25 / x2 - 1 / x3 - 0.25 / x4, 0),
        at_least(0.010085 - 0.16 / x1 - 0.36 / x2 - 0.64 / x3 - 0.64 / x4, 0),
    ]


@problem(start=(1, 1, 1, 1), optimum=29.8943782, lower=0)
def hs73(x1, x2, x3, x4):
    spread = sqrt(0.28 * x1**2 + 0.19 * x2**2 + 20.5 * x3**2 + 0.62 * x4**2)
    return 24.55 * x1 + 26.75 * x2 + 39 * x3 + 40.5 * x4, [
        at_least(2.3 * x1 + 5.6 * x2 + 11.1 * x3 + 1.3 * x4, 5),
        at_least(12 * x1 + 11.9 * x2 + 41.8 * x3 + 52.1 * x4 - 1.645 * spread, 21),
        equal(x1 + x2 + x3 + x4, 1),
    ]


def two_generators(a):
    """Power flow with angles that differ by at most ``a``."""

    def formula(x1, x2, x3, x4):
        cost = 3 * x1 + 1e-6 * x1**3 + 2 * x2 + 2e-6 / 3 * x2**3
        return cost, [
            at_least(x4 - x3, -a),
            at_least(x3 - x4, -a),
            equal(1000 * (sin(-x3 - 0.25) + sin(-x4 - 0.25)) + 894.8 - x1, 0),
            equal(1000 * (sin(x3 - 0.25) + sin(x3 - x4 - 0.25)) + 894.8 - x2, 0),
            equal(1000 * (sin(x4 - 0.25) + sin(x4 - x3 - 0.25)) + 1294.8, 0),
        ]

    return formula


@problem((0, 0, 0, 0), 5126.49811, lower=(0, 0, -0.55, -0.55), upper=(1200, 1200, 0.55, 0.55))
def hs74(*x):
    return two_generators(0.55)(*x)


@problem((0, 0, 0, 0), 5174.4127, lower=(0, 0, -0.48, -0.48), upper=(1200, 1200, 0.48, 0.48))
def hs75(*x):
    return two_generators(0.48)(*x)


@problem(start=(0.5, 0.5, 0.5, 0.5), optimum=-4.681818182, lower=0)
def hs76(x1, x2, x3, x4):
    square = x1**2 + 0.5 * x2**2 + x3**2 + 0.5 * x4**2 - x1 * x3 + x3 * x4
    return square - x1 - 3 * x2 + x3 - x4, [
        at_least(5 - x1 - 2 * x2 - x3 - x4, 0),
        at_least(4 - 3 * x1 - x2 - 2 * x3 + x4, 0),
        at_least(x2 + 4 * x3, 1.5),
    ]


@problem(start=(2, 2, 2, 2, 2), optimum=0.24150513)
def hs77(x1, x2, x3, x4, x5):
    square = (x1 - 1) ** 2 + (x1 - x2) ** 2 + (x3 - 1) ** 2
    return square + (x4 - 1) ** 4 + (x5 - 1) ** 6, [
        equal(x1**2 * x4 + sin(x4 - x5), 2 * root(2)),
        equal(x2 + x3**4 * x4**2, 8 + root(2)),
    ]


def on_a_sphere(x1, x2, x3, x4, x5):
    return [
        equal(x1**2 + x2**2 + x3**2 + x4**2 + x5**2, 10),
        equal(x2 * x3 - 5 * x4 * x5, 0),
        equal(x1**3 + x2**3, -1),
    ]


@problem(start=(-2, 1.5, 2, -1, -1), optimum=-2.91970041)
def hs78(x1, x2, x3, x4, x5):
    return x1 * x2 * x3 * x4 * x5, on_a_sphere(x1, x2, x3, x4, x5)


@problem(start=(2, 2, 2, 2, 2), optimum=0.0787768209)
def hs79(x1, x2, x3, x4, x5):
    square = (x1 - 1) ** 2 + (x1 - x2) ** 2 + (x2 - x3) ** 2
    return square + (x3 - x4) ** 4 + (x4 - x5) ** 4, [
        equal(x1 + x2**2 + x3**3, 2 + 3 * root(2)),
        equal(x2 - x3**2 + x4, -2 + 2 * root(2)),
        equal(x1 * x5, 2),
    ]


BOX = {"lower": (-2.3, -2.3, -3.2, -3.2, -3.2), "upper": (2.3, 2.3, 3.2, 3.2, 3.2)}


@problem(start=(-2, 2, 2, -1, -1), optimum=0.0539498478, **BOX)
def hs80(x1, x2, x3, x4, x5):
    return exp(x1 * x2 * x3 * x4 * x5), on_a_sphere(x1, x2, x3, x4, x5)


@problem(start=(-2, 2, 2, -1, -1), optimum=0.0539498478, **BOX)
def hs81(x1, x2, x3, x4, x5):
    f = exp(x1 * x2 * x3 * x4 * x5) - 0.5 * (x1**3 + x2**3 + 1) ** 2
    return f, on_a_sphere(x1, x2, x3, x4, x5)


@problem((78, 33, 27, 27, 27), -30665.53867, lower=(78, 33, 27, 27, 27), upper=(102, *[45] * 4))
def hs83(x1, x2, x3, x4, x5):
    f = 5.3578547 * x3**2 + 0.8356891 * x1 * x5 + 37.293239 * x1 - 40792.141
    first = 85.334407 + 0.0056858 * x2 * x5 + 0.0006262 * x1 * x4 - 0.0022053 * x3 * x5
    second = 80.51249 + 0.0071317 * x2 * x5 + 0.0029955 * x1 * x2 + 0.0021813 * x3**2
    third = 9.300961 + 0.0047026 * x3 * x5 + 0.0012547 * x1 * x3 + 0.0019085 * x3 * x4
    return f, [between(first, 0, 92), between(second, 90, 110), between(third, 20, 25)]


@problem(
    start=(2.52, 2, 37.5, 9.25, 6.8),
    optimum=-5280335.133,
    lower=(0, 1.2, 20, 9, 6.5),
    upper=(1000, 2.4, 60, 9.3, 7),
)
def hs84(x1, x2, x3, x4, x5):
    def blend(a, b, c, d, e):
        return x1 * (a + b * x2 + c * x3 + d * x4 + e * x5)

    profit = blend(-8720288.849, 150512.5253, -156.6950325, 476470.3222, 729482.8271)
    return 24345 - profit, [
        between(blend(-145421.402, 2931.1506, -40.427932, 5106.192, 15711.36), 0, 294000),
        between(blend(-155011.1084, 4360.53352, 12.9492344, 10236.884, 13176.786), 0, 294000),
        between(blend(-326669.5104, 7390.68412, -27.8986976, 16643.076, 30988.146), 0, 277200),
    ]


COLVILLE_A = np.array(
    [
        [-16, 2, 0, 1, 0],
        [0, -2, 0, 4, 2],
        [-3.5, 0, 2, 0, 0],
        [0, -2, 0, -4, -1],
        [0, -9, -2, 1, -2.8],
        [2, 0, -4, 0, 0],
        [-1, -1, -1, -1, -1],
        [-1, -2, -3, -2, -1],
        [1, 2, 3, 4, 5],
        [1, 1, 1, 1, 1],
    ]
)
COLVILLE_B = (-40, -2, -0.25, -4, -4, -1, -40, -60, 5, 1)
COLVILLE_C = np.array(
    [
        [30, -20, -10, 32, -10],
        [-20, 39, -6, -31, 32],
        [-10, -6, 10, -6, -10],
        [32, -31, -6, 39, -20],
        [-10, 32, -10, -20, 30],
    ]
)
COLVILLE_D = (4, 8, 10, 6, 2)
COLVILLE_E = (-15, -27, -36, -18, -12)


def dot(numbers, values):
    return sum(float(a) * b for a, b in zip(numbers, values, strict=True) if a)


@problem(start=(0, 0, 0, 0, 1), optimum=-32.34867897, lower=0)
def hs86(*x):
    quadratic = sum(dot(row, x) * v for row, v in zip(COLVILLE_C, x, strict=True))
    f = dot(COLVILLE_E, x) + quadratic + dot(COLVILLE_D, [v**3 for v in x])
    return f, [at_least(dot(a, x), b) for a, b in zip(COLVILLE_A, COLVILLE_B, strict=True)]
