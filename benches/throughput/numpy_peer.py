"""Units per second of 47 normals and 18 linear measures in numpy: one round for every line that says what of, "draw" for the
measures alone, "analyse" with their statistics."""

import sys
import time

import numpy

UNITS = 1 << 18
matrix = numpy.array([[(i * 7 + k * 13) % 11 / 5 - 1 for k in range(47)] for i in range(18)])
random = numpy.random.default_rng(1)


def draw():
    return (1e-4 * random.standard_normal((UNITS, 47))) @ matrix.T


def analyse():
    measures = draw()
    centred = measures - measures.mean(axis=0)
    square = centred * centred
    deviation = numpy.sqrt(square.mean(axis=0))
    skewness = (square * centred).mean(axis=0) / deviation**3
    kurtosis = (square * square).mean(axis=0) / deviation**4
    correlation = numpy.corrcoef(measures, rowvar=False)
    extremes = measures.min(axis=0), measures.max(axis=0)
    points = numpy.percentile(measures, [0.135, 50, 99.865], axis=0)
    outside = (measures < -1e-2).sum(axis=0), (measures > 1e-2).sum(axis=0)
    return skewness, kurtosis, correlation, extremes, points, outside


rounds = {"draw": draw, "analyse": analyse}
for line in sys.stdin:
    work = rounds[line.strip()]
    start = time.perf_counter()
    work()
    print(UNITS / (time.perf_counter() - start), flush=True)
