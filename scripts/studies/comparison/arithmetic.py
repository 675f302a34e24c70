"""Rates at equal error, BD-rate and fits, from measured points (kg, bytes)."""

import bisect
import math


def front(points):
    """The points that no other beats in both error and size, by error; their sizes decrease."""
    best = []
    for kg, size in sorted(points):
        if kg > 0 and (not best or size < best[-1][1]):
            best.append((kg, size))
    return best


def size_at(points, kg):
    """Size at an error: linear between the two nearest points, both in logarithms; the coarsest
    file, if it is better than asked. None: no file is as good."""
    curve = front(points)
    at = bisect.bisect_left(curve, (kg, 0))
    if at < len(curve) and curve[at][0] == kg:
        return curve[at][1]
    if at == len(curve) > 0:
        return curve[-1][1]
    if at == 0:
        return None
    (kg0, size0), (kg1, size1) = curve[at - 1:at + 1]
    share = math.log(kg / kg0) / math.log(kg1 / kg0)
    return size0 * (size1 / size0) ** share


def _end_slope(h0, h1, d0, d1):
    slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1)
    if slope * d0 <= 0:
        return 0.0
    return 3 * d0 if d0 * d1 < 0 and abs(slope) > 3 * abs(d0) else slope


class Pchip:
    """Piecewise cubic through points with no overshoot (Fritsch and Butland 1984)."""

    def __init__(self, points):
        self.x, self.y = zip(*points)
        h = [b - a for a, b in zip(self.x, self.x[1:])]
        d = [(b - a) / w for a, b, w in zip(self.y, self.y[1:], h)]
        if len(d) == 1:
            self.slope = [d[0], d[0]]
            return
        inner = []
        for h0, h1, d0, d1 in zip(h, h[1:], d, d[1:]):
            w0, w1 = 2 * h1 + h0, h1 + 2 * h0
            inner.append((w0 + w1) / (w0 / d0 + w1 / d1) if d0 * d1 > 0 else 0.0)
        self.slope = [_end_slope(h[0], h[1], d[0], d[1]), *inner,
                      _end_slope(h[-1], h[-2], d[-1], d[-2])]

    def value_and_slope(self, x):
        i = min(max(bisect.bisect_right(self.x, x) - 1, 0), len(self.x) - 2)
        h = self.x[i + 1] - self.x[i]
        t = (x - self.x[i]) / h
        y0, y1, m0, m1 = self.y[i], self.y[i + 1], h * self.slope[i], h * self.slope[i + 1]
        a, b = 2 * (y0 - y1) + m0 + m1, 3 * (y1 - y0) - 2 * m0 - m1
        return ((a * t + b) * t + m0) * t + y0, ((3 * a * t + 2 * b) * t + m0) / h

    def integral(self, low, high):
        cuts = [low, *(x for x in self.x if low < x < high), high]
        total = 0.0
        for x0, x1 in zip(cuts, cuts[1:]):
            (y0, s0), (y1, s1) = self.value_and_slope(x0), self.value_and_slope(x1)
            h = x1 - x0
            total += h * (y0 + y1) / 2 + h * h * (s0 - s1) / 12
        return total


def bd_rate(points, reference):
    """Bjontegaard: extra bytes against the reference in per cent, averaged over the errors that
    both reach (both in logarithms). None: they have no two errors in common."""
    curves = [[(math.log(kg), math.log(size)) for kg, size in front(p)]
              for p in (points, reference)]
    if min(map(len, curves)) < 2:
        return None
    low = max(curve[0][0] for curve in curves)
    high = min(curve[-1][0] for curve in curves)
    if high <= low:
        return None
    ours, theirs = (Pchip(curve).integral(low, high) for curve in curves)
    return 100 * (math.exp((ours - theirs) / (high - low)) - 1)


def geometric_mean(values):
    """The geometric mean of positive values; None if there are none, or one is missing."""
    values = list(values)
    if not values or None in values:
        return None
    return math.exp(sum(map(math.log, values)) / len(values))


def power_fit(points):
    """(c, p) of y = c x^p by least squares in logarithms; two different x at least."""
    logs = [(math.log(x), math.log(y)) for x, y in points]
    mean_x, mean_y = (sum(column) / len(logs) for column in zip(*logs))
    p = (sum((x - mean_x) * (y - mean_y) for x, y in logs)
         / sum((x - mean_x) ** 2 for x, _ in logs))
    return math.exp(mean_y - p * mean_x), p
