"""Inflates zlib streams (RFC 1950, RFC 1951) check by check, so that checks can be left out.

Without a check, inflating continues as a reader most likely would: a length before the first is
0, bytes before the first are 0, and symbols without a meaning have the base 0.
"""

import zlib

_ORDER = (16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15)
_END_OF_BLOCK = 256


class Fault(Exception):
    """A check that failed; its text says which."""


def _symbols(first, extra, last):
    """(base, number of extra bits) of each symbol; the last ones are those of `last`."""
    found, base = [], first
    for bits in extra:
        found.append((base, bits))
        base += 1 << bits
    return found + last


_LENGTHS = _symbols(3, [0] * 8 + [b for b in range(1, 6) for _ in range(4)],
                    [(258, 0), (0, 0), (0, 0)])
_DISTANCES = _symbols(1, [0] * 4 + [b for b in range(1, 14) for _ in range(2)], [(0, 0), (0, 0)])
_FIXED = [8] * 144 + [9] * 112 + [7] * 24 + [8] * 8


class Inflater:
    """One zlib stream. without: checks that are left out."""

    def __init__(self, data, without=()):
        self._data = data
        self._without = without
        self._bit = 0
        self.out = bytearray()

    def _check(self, condition, name):
        if not condition and name not in self._without:
            raise Fault(name)

    def inflate(self):
        method, flags = self._byte(), self._byte()
        self._check((256 * method + flags) % 31 == 0, "header check")
        self._check(method & 15 == 8, "method")
        self._check(method >> 4 <= 7, "window size")
        self._check(flags & 32 == 0, "dictionary")
        if flags & 32 and "dictionary id" not in self._without:
            self._bit += 32
        last = 0
        while last == 0:
            last = self._bits(1)
            self._block(self._bits(2))
        self._align()
        check_sum = int.from_bytes(bytes(self._byte() for _ in range(4)), "big")
        self._check(check_sum == zlib.adler32(self.out), "check sum")
        self._check(self._bit == 8 * len(self._data), "rest")
        return bytes(self.out)

    def _bits(self, n):
        value = 0
        for i in range(n):
            if self._bit >= 8 * len(self._data):
                raise Fault("end")
            value |= (self._data[self._bit // 8] >> self._bit % 8 & 1) << i
            self._bit += 1
        return value

    def _byte(self):
        return self._bits(8)

    def _align(self):
        self._bit += -self._bit % 8

    def _block(self, kind):
        self._check(kind < 3, "block type")
        if kind == 0:
            self._stored()
        elif kind == 1:
            self._codes(_Code(_FIXED), _Code([5] * 32))
        elif kind == 2:
            self._codes(*self._dynamic())

    def _stored(self):
        self._align()
        size, complement = self._bits(16), self._bits(16)
        self._check(size ^ complement == 65535, "stored length")
        self.out += bytes(self._byte() for _ in range(size))

    def _dynamic(self):
        literals, distances, count = self._bits(5) + 257, self._bits(5) + 1, self._bits(4) + 4
        lengths = [0] * 19
        for place in _ORDER[:count]:
            lengths[place] = self._bits(3)
        code, lengths = _Code(lengths), []
        self._check(code.left >= 0, "code lengths")
        while len(lengths) < literals + distances:
            lengths += self._run(code.symbol(self._bits), lengths)
        self._check(len(lengths) == literals + distances, "repeat past end")
        codes = _Code(lengths[:literals]), _Code(lengths[literals:literals + distances])
        self._check(codes[0].left >= 0 and codes[1].left >= 0, "code lengths")
        return codes

    def _run(self, symbol, lengths):
        if symbol < 16:
            return [symbol]
        if symbol == 16:
            self._check(lengths, "first repeat")
            return [lengths[-1] if lengths else 0] * (3 + self._bits(2))
        return [0] * (3 + self._bits(3) if symbol == 17 else 11 + self._bits(7))

    def _codes(self, literal_code, distance_code):
        while (symbol := literal_code.symbol(self._bits)) != _END_OF_BLOCK:
            if symbol < _END_OF_BLOCK:
                self.out.append(symbol)
                continue
            self._check(symbol < 286, "length symbol")
            base, extra = _LENGTHS[symbol - 257]
            length = base + self._bits(extra)
            self._check(not distance_code.empty(), "absent distance code")
            symbol = 0 if distance_code.empty() else distance_code.symbol(self._bits)
            self._check(symbol < 30, "distance symbol")
            base, extra = _DISTANCES[symbol]
            self._copy(length, base + self._bits(extra))

    def _copy(self, length, distance):
        self._check(distance <= len(self.out), "distance too far")
        for _ in range(length):
            at = len(self.out) - distance
            self.out.append(self.out[at] if 0 <= at < len(self.out) else 0)


class _Code:
    """A canonical prefix code from the lengths of its symbols."""

    def __init__(self, lengths):
        self._symbols = {}
        self.left = 1  # codes of the greatest length that stay unused; negative: too many
        code = 0
        for length in range(1, 16):
            code, self.left = 2 * code, 2 * self.left
            for symbol, own in enumerate(lengths):
                if own == length:
                    self._symbols.setdefault((length, code), symbol)
                    code, self.left = code + 1, self.left - 1

    def empty(self):
        return not self._symbols

    def symbol(self, bits):
        code = 0
        for length in range(1, 16):
            code = 2 * code + bits(1)
            if (length, code) in self._symbols:
                return self._symbols[length, code]
        raise Fault("code")
