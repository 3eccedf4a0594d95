"""Constrained problems of Hock and Schittkowski, "Test Examples for Nonlinear Programming Codes"
(Springer, 1981): statements, published starts and optima; those numbered 6 to 53.

Each statement was solved by IPOPT too and its derivatives held against differences. Where the
book's optimum is less exact than its statement, the exact one stands here.
"""

from __future__ import annotations

from math import inf, pi
from math import log as ln
from math import sqrt as root

from .jets import cos, exp, log, sin
from .problem import at_least, equal, problem


@problem(start=(-1.2, 1), optimum=0)
def hs6(x1, x2):
    return (1 - x1) ** 2, [equal(10 * (x2 - x1**2), 0)]


@problem(start=(2, 2), optimum=-root(3))
def hs7(x1, x2):
    return log(1 + x1**2) - x2, [equal((1 + x1**2) ** 2 + x2**2, 4)]


@problem(start=(2, 1), optimum=-1)
def hs8(x1, x2):
    return -1.0, [equal(x1**2 + x2**2, 25), equal(x1 * x2, 9)]


@problem(start=(0, 0), optimum=-0.5)
def hs9(x1, x2):
    return sin(pi * x1 / 12) * cos(pi * x2 / 16), [equal(4 * x1 - 3 * x2, 0)]


@problem(start=(-10, 10), optimum=-1)
def hs10(x1, x2):
    return x1 - x2, [at_least(-3 * x1**2 + 2 * x1 * x2 - x2**2 + 1, 0)]


@problem(start=(4.9, 0.1), optimum=-8.498464223)
def hs11(x1, x2):
    return (x1 - 5) ** 2 + x2**2 - 25, [at_least(-(x1**2) + x2, 0)]


@problem(start=(0, 0), optimum=-30)
def hs12(x1, x2):
    return 0.5 * x1**2 + x2**2 - x1 * x2 - 7 * x1 - 7 * x2, [at_least(25 - 4 * x1**2 - x2**2, 0)]


@problem(start=(-2, -2), optimum=1, lower=0)
def hs13(x1, x2):
    return (x1 - 2) ** 2 + x2**2, [at_least((1 - x1) ** 3 - x2, 0)]


@problem(start=(2, 2), optimum=9 - 2.875 * root(7))
def hs14(x1, x2):
    return (x1 - 2) ** 2 + (x2 - 1) ** 2, [
        at_least(-0.25 * x1**2 - x2**2 + 1, 0),
        equal(x1 - 2 * x2 + 1, 0),
    ]


def rosenbrock(x1, x2):
    return 100 * (x2 - x1**2) ** 2 + (1 - x1) ** 2


@problem(start=(-2, 1), optimum=306.5, upper=(0.5, inf))
def hs15(x1, x2):
    return rosenbrock(x1, x2), [at_least(x1 * x2, 1), at_least(x1 + x2**2, 0)]


@problem(start=(-2, 1), optimum=0.25, lower=(-2, -inf), upper=(0.5, 1))
def hs16(x1, x2):
    return rosenbrock(x1, x2), [at_least(x1 + x2**2, 0), at_least(x1**2 + x2, 0)]


@problem(start=(-2, 1), optimum=1, lower=(-0.5, -inf), upper=(0.5, 1))
def hs17(x1, x2):
    return rosenbrock(x1, x2), [at_least(x2**2 - x1, 0), at_least(x1**2 - x2, 0)]


@problem(start=(2, 2), optimum=5, lower=(2, 0), upper=(50, 50))
def hs18(x1, x2):
    return 0.01 * x1**2 + x2**2, [at_least(x1 * x2, 25), at_least(x1**2 + x2**2, 25)]


@problem(start=(20.1, 5.84), optimum=-6961.81388, lower=(13, 0), upper=(100, 100))
def hs19(x1, x2):
    return (x1 - 10) ** 3 + (x2 - 20) ** 3, [
        at_least((x1 - 5) ** 2 + (x2 - 5) ** 2, 100),
        at_least(82.81 - (x2 - 5) ** 2 - (x1 - 6) ** 2, 0),
    ]


@problem(start=(-2, 1), optimum=81.5 - 25 * root(3), lower=(-0.5, -inf), upper=(0.5, inf))
def hs20(x1, x2):
    return rosenbrock(x1, x2), [
        at_least(x1 + x2**2, 0),
        at_least(x1**2 + x2, 0),
        at_least(x1**2 + x2**2, 1),
    ]


@problem(start=(-1, -1), optimum=-99.96, lower=(2, -50), upper=(50, 50))
def hs21(x1, x2):
    return 0.01 * x1**2 + x2**2 - 100, [at_least(10 * x1 - x2, 10)]


@problem(start=(2, 2), optimum=1)
def hs22(x1, x2):
    return (x1 - 2) ** 2 + (x2 - 1) ** 2, [at_least(2 - x1 - x2, 0), at_least(x2 - x1**2, 0)]


@problem(start=(3, 1), optimum=2, lower=-50, upper=50)
def hs23(x1, x2):
    return x1**2 + x2**2, [
        at_least(x1 + x2, 1),
        at_least(x1**2 + x2**2, 1),
        at_least(9 * x1**2 + x2**2, 9),
        at_least(x1**2 - x2, 0),
        at_least(x2**2 - x1, 0),
    ]


@problem(start=(1, 0.5), optimum=-1, lower=0)
def hs24(x1, x2):
    return ((x1 - 3) ** 2 - 9) * x2**3 / (27 * root(3)), [
        at_least(x1 / root(3) - x2, 0),
        at_least(x1 + root(3) * x2, 0),
        at_least(6 - x1 - root(3) * x2, 0),
    ]


@problem(start=(-2.6, 2, 2), optimum=0)
def hs26(x1, x2, x3):
    return (x1 - x2) ** 2 + (x2 - x3) ** 4, [equal((1 + x2**2) * x1 + x3**4, 3)]


@problem(start=(2, 2, 2), optimum=0.04)
def hs27(x1, x2, x3):
    return 0.01 * (x1 - 1) ** 2 + (x2 - x1**2) ** 2, [equal(x1 + x3**2, -1)]


@problem(start=(-4, 1, 1), optimum=0)
def hs28(x1, x2, x3):
    return (x1 + x2) ** 2 + (x2 + x3) ** 2, [equal(x1 + 2 * x2 + 3 * x3, 1)]


@problem(start=(1, 1, 1), optimum=-16 * root(2))
def hs29(x1, x2, x3):
    return -x1 * x2 * x3, [at_least(48 - x1**2 - 2 * x2**2 - 4 * x3**2, 0)]


@problem(start=(1, 1, 1), optimum=1, lower=(1, -10, -10), upper=10)
def hs30(x1, x2, x3):
    return x1**2 + x2**2 + x3**2, [at_least(x1**2 + x2**2, 1)]


@problem(start=(1, 1, 1), optimum=6, lower=(-10, 1, -10), upper=(10, 10, 1))
def hs31(x1, x2, x3):
    return 9 * x1**2 + x2**2 + 9 * x3**2, [at_least(x1 * x2, 1)]


@problem(start=(0.1, 0.7, 0.2), optimum=1, lower=0)
def hs32(x1, x2, x3):
    return (x1 + 3 * x2 + x3) ** 2 + 4 * (x1 - x2) ** 2, [
        at_least(6 * x2 + 4 * x3 - x1**3, 3),
        equal(x1 + x2 + x3, 1),
    ]


@problem(start=(0, 0, 3), optimum=root(2) - 6, lower=0, upper=(inf, inf, 5))
def hs33(x1, x2, x3):
    return (x1 - 1) * (x1 - 2) * (x1 - 3) + x3, [
        at_least(x3**2 - x2**2 - x1**2, 0),
        at_least(x1**2 + x2**2 + x3**2, 4),
    ]


@problem(start=(0, 1.05, 2.9), optimum=-ln(ln(10)), lower=0, upper=(100, 100, 10))
def hs34(x1, x2, x3):
    return -x1, [at_least(x2 - exp(x1), 0), at_least(x3 - exp(x2), 0)]


@problem(start=(0.5, 0.5, 0.5), optimum=1 / 9, lower=0)
def hs35(x1, x2, x3):
    square = 2 * x1**2 + 2 * x2**2 + x3**2 + 2 * x1 * x2 + 2 * x1 * x3
    return 9 - 8 * x1 - 6 * x2 - 4 * x3 + square, [at_least(3 - x1 - x2 - 2 * x3, 0)]


@problem(start=(10, 10, 10), optimum=-3300, lower=0, upper=(20, 11, 42))
def hs36(x1, x2, x3):
    return -x1 * x2 * x3, [at_least(72 - x1 - 2 * x2 - 2 * x3, 0)]


@problem(start=(10, 10, 10), optimum=-3456, lower=0, upper=42)
def hs37(x1, x2, x3):
    girth = x1 + 2 * x2 + 2 * x3
    return -x1 * x2 * x3, [at_least(72 - girth, 0), at_least(girth, 0)]


@problem(start=(2, 2, 2, 2), optimum=-1)
def hs39(x1, x2, x3, x4):
    return -x1, [equal(x2 - x1**3 - x3**2, 0), equal(x1**2 - x2 - x4**2, 0)]


@problem(start=(0.8, 0.8, 0.8, 0.8), optimum=-0.25)
def hs40(x1, x2, x3, x4):
    return -x1 * x2 * x3 * x4, [
        equal(x1**3 + x2**2, 1),
        equal(x1**2 * x4 - x3, 0),
        equal(x4**2 - x2, 0),
    ]


@problem(start=(2, 2, 2, 2), optimum=52 / 27, lower=0, upper=(1, 1, 1, 2))
def hs41(x1, x2, x3, x4):
    return 2 - x1 * x2 * x3, [equal(x1 + 2 * x2 + 2 * x3 - x4, 0)]


@problem(start=(1, 1, 1, 1), optimum=28 - 10 * root(2))
def hs42(x1, x2, x3, x4):
    return (x1 - 1) ** 2 + (x2 - 2) ** 2 + (x3 - 3) ** 2 + (x4 - 4) ** 2, [
        equal(x1, 2),
        equal(x3**2 + x4**2, 2),
    ]


@problem(start=(0, 0, 0, 0), optimum=-44)
def hs43(x1, x2, x3, x4):
    square = x1**2 + x2**2 + 2 * x3**2 + x4**2
    return square - 5 * x1 - 5 * x2 - 21 * x3 + 7 * x4, [
        at_least(8 - x1**2 - x2**2 - x3**2 - x4**2 - x1 + x2 - x3 + x4, 0),
        at_least(10 - x1**2 - 2 * x2**2 - x3**2 - 2 * x4**2 + x1 + x4, 0),
        at_least(5 - 2 * x1**2 - x2**2 - x3**2 - 2 * x1 + x2 + x4, 0),
    ]


@problem(start=(0, 0, 0, 0), optimum=-15, lower=0)
def hs44(x1, x2, x3, x4):
    return x1 - x2 - x3 - x1 * x3 + x1 * x4 + x2 * x3 - x2 * x4, [
        at_least(8 - x1 - 2 * x2, 0),
        at_least(12 - 4 * x1 - x2, 0),
        at_least(12 - 3 * x1 - 4 * x2, 0),
        at_least(8 - 2 * x3 - x4, 0),
        at_least(8 - x3 - 2 * x4, 0),
        at_least(5 - x3 - x4, 0),
    ]


@problem(start=(2, 2, 2, 2, 2), optimum=1, lower=0, upper=(1, 2, 3, 4, 5))
def hs45(x1, x2, x3, x4, x5):
    return 2 - x1 * x2 * x3 * x4 * x5 / 120, []


@problem(start=(root(2) / 2, 1.75, 0.5, 2, 2), optimum=0)
def hs46(x1, x2, x3, x4, x5):
    return (x1 - x2) ** 2 + (x3 - 1) ** 2 + (x4 - 1) ** 4 + (x5 - 1) ** 6, [
        equal(x1**2 * x4 + sin(x4 - x5), 1),
        equal(x2 + x3**4 * x4**2, 2),
    ]


@problem(start=(2, root(2), -1, 2 - root(2), 0.5), optimum=0)
def hs47(x1, x2, x3, x4, x5):
    return (x1 - x2) ** 2 + (x2 - x3) ** 3 + (x3 - x4) ** 4 + (x4 - x5) ** 4, [
        equal(x1 + x2**2 + x3**3, 3),
        equal(x2 - x3**2 + x4, 1),
        equal(x1 * x5, 1),
    ]


@problem(start=(3, 5, -3, 2, -2), optimum=0)
def hs48(x1, x2, x3, x4, x5):
    return (x1 - 1) ** 2 + (x2 - x3) ** 2 + (x4 - x5) ** 2, [
        equal(x1 + x2 + x3 + x4 + x5, 5),
        equal(x3 - 2 * (x4 + x5), -3),
    ]


@problem(start=(10, 7, 2, -3, 0.8), optimum=0)
def hs49(x1, x2, x3, x4, x5):
    return (x1 - x2) ** 2 + (x3 - 1) ** 2 + (x4 - 1) ** 4 + (x5 - 1) ** 6, [
        equal(x1 + x2 + x3 + 4 * x4, 7),
        equal(x3 + 5 * x5, 6),
    ]


@problem(start=(35, -31, 11, 5, -5), optimum=0)
def hs50(x1, x2, x3, x4, x5):
    return (x1 - x2) ** 2 + (x2 - x3) ** 2 + (x3 - x4) ** 4 + (x4 - x5) ** 2, [
        equal(x1 + 2 * x2 + 3 * x3, 6),
        equal(x2 + 2 * x3 + 3 * x4, 6),
        equal(x3 + 2 * x4 + 3 * x5, 6),
    ]


@problem(start=(2.5, 0.5, 2, -1, 0.5), optimum=0)
def hs51(x1, x2, x3, x4, x5):
    return (x1 - x2) ** 2 + (x2 + x3 - 2) ** 2 + (x4 - 1) ** 2 + (x5 - 1) ** 2, [
        equal(x1 + 3 * x2, 4),
        equal(x3 + x4 - 2 * x5, 0),
        equal(x2 - x5, 0),
    ]


@problem(start=(2, 2, 2, 2, 2), optimum=1859 / 349)
def hs52(x1, x2, x3, x4, x5):
    return (4 * x1 - x2) ** 2 + (x2 + x3 - 2) ** 2 + (x4 - 1) ** 2 + (x5 - 1) ** 2, [
        equal(x1 + 3 * x2, 0),
        equal(x3 + x4 - 2 * x5, 0),
        equal(x2 - x5, 0),
    ]


@problem(start=(2, 2, 2, 2, 2), optimum=176 / 43, lower=-10, upper=10)
def hs53(x1, x2, x3, x4, x5):
    return (x1 - x2) ** 2 + (x2 + x3 - 2) ** 2 + (x4 - 1) ** 2 + (x5 - 1) ** 2, [
        equal(x1 + 3 * x2, 0),
        equal(x3 + x4 - 2 * x5, 0),
        equal(x2 - x5, 0),
    ]
