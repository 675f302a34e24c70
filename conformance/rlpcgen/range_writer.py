"""A range encoder for clause 9.3, whose bytes lead a range decoder to given decisions."""


class RangeWriter:
    """A range encoder: the bytes with which a range decoder takes the given decisions."""

    def __init__(self):
        self.bytes = bytearray()
        self.low = 0  # lower end of the range, in the next 32 bits
        self.carries = []  # length of each carry, in bytes

    def narrow(self, by, shifts):
        """The range now begins `by` higher; then the decoder took `shifts` bytes."""
        self.low += by
        self._carry()
        for _ in range(shifts):
            self.bytes.append(self.low >> 24)
            self.low = (self.low << 8) & 0xFFFFFFFF

    def _carry(self):
        if self.low >> 32 == 0:
            return
        self.low &= 0xFFFFFFFF
        at = len(self.bytes) - 1
        while self.bytes[at] == 255:
            self.bytes[at] = 0
            at -= 1
        self.bytes[at] += 1
        self.carries.append(len(self.bytes) - at)

    def finish(self, size, highest=False):
        """Appends the lowest or the highest byte after which zeros lie in the range."""
        if highest:
            self.low = (self.low + size - 1) & ~0xFFFFFF
        else:
            self.low = (self.low + 0xFFFFFF) & ~0xFFFFFF
        self._carry()
        self.bytes.append(self.low >> 24)
        return bytes(self.bytes)
