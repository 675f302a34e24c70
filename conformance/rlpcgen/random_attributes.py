"""Random attribute units (Annex F)."""


class AttributePlan:
    """Character of the attributes of a random stream."""

    def __init__(self, numbers):
        n = numbers
        self.percent = n.pick([0, 40])  # for each place where the unit can be
        self.sets = n.pick([1, n.between(1, 4)])
        self.kinds = n.pick([[0, 1, 2, 3], [n.between(0, 3)]])
        self.seam_percent = n.pick([0, 5, 50, 100])
        self.diagonal_percent = n.pick([0, 20, 90])
        self.same_percent = n.pick([10, 60])
        self.width = n.between(0, 12)  # residuals, in bits


class AttributeSource:
    """Values of the elements of attribute units, for a source with numbers, near and residual."""

    _names = 0  # number of names in the unit
    _name = b""

    def _num_attribute_sets_minus1(self, ns, indices, arguments):
        self._names = 0
        return self.plan.attributes.sets - 1

    def _attribute_name_size_minus1(self, ns, indices, arguments):
        """Each name begins with its number, so that no two are the same (R-ATT-09)."""
        self._name = str(self._names).encode() + b"-" * self.numbers.between(0, 4)
        self._names += 1
        return len(self._name) - 1

    def _attribute_name_byte(self, ns, indices, arguments):
        byte, self._name = self._name[0], self._name[1:]
        return byte

    def _attribute_domain(self, ns, indices, arguments):
        return self.numbers.between(0, 2)

    def _value_kind(self, ns, indices, arguments):
        kind = self.numbers.pick(self.plan.attributes.kinds)
        return kind if ns["attribute_domain"] < 2 else min(kind, 2)

    def _num_components_minus1(self, ns, indices, arguments):
        return self.numbers.pick([0, 1, 1, 2, 3])

    def _value_bits_minus1(self, ns, indices, arguments):
        return self.near(int(ns["value_kind"] == 1), 15)

    def _value_scale_idc(self, ns, indices, arguments):
        return self.numbers.between(0, 2)

    def _value_log2_step(self, ns, indices, arguments):
        return self.near(-126, 127)

    def _value_origin(self, ns, indices, arguments):
        return self.near(-16777216, 16777216)

    def _prediction_idc(self, ns, indices, arguments):
        if self.unit_code != ns["ATTRIBUTES"]:
            return super()._prediction_idc(ns, indices, arguments)
        return self.numbers.pick([0, 1, 2, 2] if ns["CanUsePositions"]() else [0, 1])

    def _smoothing_weight_idc(self, ns, indices, arguments):
        return self.numbers.between(0, 2)

    _diagonal_idc = _smoothing_weight_idc

    def _first_frame_crc(self, ns, indices, arguments):
        return None  # the right one

    def _seam_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(self.plan.attributes.seam_percent))

    def _diagonal_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(self.plan.attributes.diagonal_percent))

    def _value_residual(self, ns, indices, arguments):
        return self.residual(width=self.plan.attributes.width)

    _triangle_residual = _value_residual

    def _float_size(self, ns, indices, arguments):
        return self.near(0, 32)

    def _float_sign(self, ns, indices, arguments):
        return self.numbers.between(0, 1)

    def _float_low_bits(self, ns, indices, arguments):
        return self.near(0, (1 << arguments[0]) - 1)

    def _same_value_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(self.plan.attributes.same_percent))
