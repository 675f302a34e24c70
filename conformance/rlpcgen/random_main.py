"""Random legal streams of the Main profile: skinned GOFs with slices, and cluster GOFs."""

import random_streams


class MainPlan(random_streams.Plan):
    """Character of a random stream of the Main profile."""

    def __init__(self, numbers):
        super().__init__(numbers)
        n = numbers
        self.deep = False
        if n.chance(15):  # more layers
            self.triangles = n.between(100, 300)
        self.bones_percent = n.pick([100, 50, 50, 0])  # share of skinned GOFs
        if self.bones_percent == 50:
            self.frames = n.between(2, 12)
        self.gof_frames = n.pick([self.frames, 3])  # at most
        self.bones = n.pick([1, 1, 2, n.between(1, 6), n.between(1, 30)])
        self.prediction = n.pick([0, 1, 2, 3, 3, 3])
        self.weight_bits = n.pick([0, 1, 5, 7])
        self.groups = n.pick([0, 1, 1, 2, n.between(0, 5)])
        if n.chance(2):
            self.groups, self.components = 255, 0
        self.extra_percent = n.pick([2, 20, 60])
        self.still_percent = n.pick([0, 30, 100])  # bones without rotation or origin
        self.cut_percent = n.pick([0, 0, 30])


class MainSource(random_streams.RandomSource):
    """Values of the elements of skinned GOFs, slices and cluster GOFs."""

    def _profile_idc(self, ns, indices, arguments):
        return 1

    def _num_gof_frames_minus1(self, ns, indices, arguments):
        left = ns["NumFrames"] - ns["NumParsedFrames"]
        return self.near(0, min(left, self.plan.gof_frames) - 1)

    def _bones_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(self.plan.bones_percent))

    def _num_bones_minus1(self, ns, indices, arguments):
        return min(self.plan.bones, ns["MaxClusters"]) - 1

    def _weight_bits(self, ns, indices, arguments):
        return self.plan.weight_bits

    def _rest_step_minus1(self, ns, indices, arguments):
        return self.near(0, 65535)

    def _num_component_groups(self, ns, indices, arguments):
        return self.plan.groups

    def _prediction_idc(self, ns, indices, arguments):
        return self.plan.prediction

    def _damping_log2(self, ns, indices, arguments):
        return self.near(0, 15)

    _outer_weight = _outer_scale = _layer_step_minus1 = _damping_log2

    def _num_layer_groups_minus1(self, ns, indices, arguments):
        self._left = ns["NumLayers"]
        return self.near(0, min(ns["NumLayers"], 5) - 1)

    def _layer_group_layers_minus1(self, ns, indices, arguments):
        after = ns["num_layer_groups_minus1"] - indices[0]
        taken = self.numbers.between(1, self._left - after)
        self._left -= taken
        return taken - 1

    def _bone_parent_plus1(self, ns, indices, arguments):
        return self.numbers.between(0, len(ns["BoneParent"]))

    def _bone_pivot(self, ns, indices, arguments):
        return self.near(0, (1 << (ns["position_bits"] + 5)) - 1)

    def _rotation_flag(self, ns, indices, arguments):
        return int(not self.numbers.chance(self.plan.still_percent))

    _origin_flag = _rotation_flag

    def _rotation_step_idx(self, ns, indices, arguments):
        return self.near(0, 239)

    _origin_step_idx = _rotation_step_idx

    def _rotation_order_minus1(self, ns, indices, arguments):
        return self.numbers.between(0, 3)

    def _origin_order(self, ns, indices, arguments):
        return self.numbers.between(0, 4)

    def _rotation_residual(self, ns, indices, arguments):
        return self.residual()

    _origin_residual = _vertex_residual = _rotation_residual

    def _component_group_idx(self, ns, indices, arguments):
        return self.slice[0]

    def _layer_group_idx(self, ns, indices, arguments):
        return self.slice[1]

    def _num_group_components_minus1(self, ns, indices, arguments):
        return self.numbers.between(0, 2 * self.plan.components)

    def _temporal_predictor(self, ns, indices, arguments):
        return self.numbers.between(0, 7 if ns["gof_kind"] > 0 else 4)

    def _temporal_weight(self, ns, indices, arguments):
        return self.near(0, 511)

    def _trajectory_residual(self, ns, indices, arguments):
        return self.residual(width=self._width)

    def _extra_bone_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(self.plan.extra_percent))

    def _extra_bone(self, ns, indices, arguments):
        return self.numbers.pick([b for b in range(ns["NumBones"]) if ns["IsNewBone"](b)])

    def _extra_bone_weight_minus1(self, ns, indices, arguments):
        return self.near(0, ns["WeightLeft"] - 1)

    def _weight_residual(self, ns, indices, arguments):
        return self.residual(width=min(self.plan.width, 8))


class MainSequence(random_streams.Sequence):
    """The units of a random stream of the Main profile."""

    version_minor = 1

    def _gof(self):
        self._unit("GOF")
        if self._writer.ns["gof_kind"] > 0:
            self._slices()

    def _slices(self):
        ns = self._writer.ns
        self._groups(range(ns["num_component_groups"] + 1), ns["num_layer_groups_minus1"] + 1)

    def _groups(self, groups, max_layers):
        """The slices of component groups, with at most max_layers layer groups each."""
        for group in groups:
            if self._n.chance(self._plan.cut_percent):
                max_layers = self._n.between(0, max_layers)
            for layers in range(max_layers):
                self._slice(group, layers)
            if max_layers == 0:
                break

    def _slice(self, group, layers):
        self._writer.source.slice = group, layers
        self._unit("SLICE")


class MainBuilder(random_streams.RandomBuilder):
    def __init__(self, program):
        super().__init__(program, MainPlan, MainSource, MainSequence)
