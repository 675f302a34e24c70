"""Random legal streams of the High profile: shared rigs and GOFs that use them, too."""

import random_attributes
import random_main
import random_streams


class HighPlan(random_main.MainPlan):
    """Character of a random stream of the High profile."""

    def __init__(self, numbers):
        super().__init__(numbers)
        n = numbers
        self.rigs_percent = n.pick([0, 30, 60])  # shared rigs before a GOF
        if self.rigs_percent:
            self.gof_frames = n.pick([1, 3])
        self.tracks_percent = n.pick([50, 100])  # per cent of the GOFs that can use a shared rig
        self.present_percent = n.pick([100, 70, 0])  # trajectories that occur in a GOF
        self.local_groups = n.pick([0, 0, 1, n.between(0, 3)])
        self.frames_percent = n.pick([0, 0, 30, 100])  # share of inter GOFs
        self.open_end = n.chance(30)
        self.attributes = random_attributes.AttributePlan(n)


class HighSource(random_attributes.AttributeSource, random_main.MainSource):
    """Values of the elements that the Main profile does not have, too."""

    temporal_layer = 0  # layer of the slice
    ends_gof = False  # the frame unit ends the GOF
    unit_frames = 1  # frames in the frame unit
    clip_end = 0  # end of the last clip of a table

    def _profile_idc(self, ns, indices, arguments):
        return 2

    def _num_adaptive_factors(self, ns, indices, arguments):
        return self.numbers.pick([0, 1, 2, 5, ns["MaxComponents"]])

    def _num_clips_minus1(self, ns, indices, arguments):
        self.clip_end = 0
        return self.numbers.between(0, 3)

    def _clip_gap(self, ns, indices, arguments):
        gap = self.near(-self.clip_end, ns["NumFrames"] - 1 - self.clip_end)
        self.clip_end += gap
        return gap

    def _clip_num_frames_minus1(self, ns, indices, arguments):
        more = self.near(0, ns["NumFrames"] - 1 - self.clip_end)
        self.clip_end += more + 1
        return more

    def _clip_name_size_minus1(self, ns, indices, arguments):
        return self.numbers.between(0, 5)

    def _clip_name_byte(self, ns, indices, arguments):
        return self.numbers.between(0x20, 0x7E)

    def _stretch_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(40))

    def _stretch_idc(self, ns, indices, arguments):
        return self.numbers.between(0, 2)

    def _stretch_axes(self, ns, indices, arguments):
        return self.near(0, 65535)

    def _stretch_step_idx(self, ns, indices, arguments):
        return self.near(0, 239)

    def _stretch_order(self, ns, indices, arguments):
        return self.numbers.between(0, 4)

    def _stretch_residual(self, ns, indices, arguments):
        return self.residual()

    def _rest_order_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(60))

    def _rest_edge_weight(self, ns, indices, arguments):
        return self.near(0, 63)

    _rest_ring_weight = _rest_edge_weight

    def _rest_axes_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(50))

    _rest_counterparts_flag = _counterpart_mirrored_flag = _rest_axes_flag
    _counterpart_flag = _new_counterpart_flag = _rest_axes_flag

    def _counterpart_hinge(self, ns, indices, arguments):
        listed = 0
        for v in ns["RestOrder"]:  # to the current vertex
            if listed == len(ns["HingeList"]) and ns["RestHinges"][v]:
                return self.numbers.between(0, len(ns["RestHinges"][v]) - 1)
            listed += len(ns["RestHinges"][v])
        raise AssertionError("no vertex has hinges that are not listed")

    def _counterpart_idx(self, ns, indices, arguments):
        return self.numbers.between(0, len(ns["HingeList"]) - 1)

    def _gof_kind(self, ns, indices, arguments):
        if self.numbers.chance(self.plan.frames_percent):
            return 3
        if _kept(ns) and self.numbers.chance(self.plan.tracks_percent):
            return 2
        return self._bones_flag(ns, indices, arguments)

    def _rig_idx(self, ns, indices, arguments):
        if self.unit_code == ns["RIG"]:
            return self.numbers.pick([0, 0, 1, self.numbers.between(0, 7)])
        return self.numbers.pick(_kept(ns))

    def _open_end_flag(self, ns, indices, arguments):
        return int(self.plan.open_end)

    def _num_sequence_frames(self, ns, indices, arguments):
        return ns["NumParsedFrames"]

    def _frame_pattern_idc(self, ns, indices, arguments):
        return self.numbers.between(0, 3)

    def _exact_flag(self, ns, indices, arguments):
        return self.numbers.between(0, 1)

    _frame_hash_flag = _exact_flag

    def _max_earlier_distance(self, ns, indices, arguments):
        return self.numbers.pick([0, 0, self.numbers.between(1, 4)])

    def _earlier_flag(self, ns, indices, arguments):
        return int(bool(self._earlier(ns)) and self.numbers.chance(40))

    def _repeat_flag(self, ns, indices, arguments):
        return self.numbers.between(0, 1)

    def _earlier_distance_minus1(self, ns, indices, arguments):
        return self.numbers.pick(self._earlier(ns))

    def _earlier(self, ns):
        place = ns["PlaceOfFrame"][ns["UnitFrame"]]
        layer = ns["TemporalLayerOfFrame"]
        maximum = layer(ns["UnitFrame"])
        return [i for i in range(min(place, ns["max_earlier_distance"]))
                if layer(ns["FrameOrder"][place - 1 - i]) <= maximum]

    def _pattern_period_log2(self, ns, indices, arguments):
        return self.numbers.between(1, 3)

    def _pattern_period_minus1(self, ns, indices, arguments):
        return self.numbers.between(0, 3)

    def _pattern_offset_minus1(self, ns, indices, arguments):
        free = [i - 1 for i, depth in enumerate(ns["DepthAtOffset"]) if depth < 0]
        return self.numbers.pick(free)

    def _two_references_flag(self, ns, indices, arguments):
        after = ns["DepthAtOffset"][_offset(ns) + 1:]
        return int(max(after, default=-1) >= 0 and self.numbers.chance(70))

    def _pattern_reference(self, ns, indices, arguments):
        offset, depths = _offset(ns), ns["DepthAtOffset"]
        known = [i for i, depth in enumerate(depths) if depth >= 0]
        if ns["two_references_flag"]:
            known = [i for i in known if (i > offset) == (indices[1] == 1)]
        if offset == ns["PatternPeriod"]:
            known = [i for i in known if depths[i] == 0]
        return self.numbers.pick(known)

    def _pattern_depth(self, ns, indices, arguments):
        if _offset(ns) == ns["PatternPeriod"]:
            return 0
        references = ns["pattern_reference"][indices[0]]
        return self.numbers.between(max(ns["DepthAtOffset"][i] for i in references), 3)

    def _temporal_layers_minus1(self, ns, indices, arguments):
        maximum = ns["MaxLearningVertices"] // ns["NumVertices"]
        return self.near(0, min(ns["NumDepths"], maximum) - 1)

    def _gof_end_flag(self, ns, indices, arguments):
        return int(self.ends_gof)

    def _frame_step_minus1(self, ns, indices, arguments):
        return self.near(0, 65535)

    def _frame_step_delta_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(40))

    def _frame_step_delta(self, ns, indices, arguments):
        return self.numbers.pick([0, self.numbers.between(-8, 8), self.near(-15, 240)])

    def _learning_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(70))

    def _prime_log2(self, ns, indices, arguments):
        return self.near(0, 15)

    def _frame_idx(self, ns, indices, arguments):
        return self.slice[0]

    def _unit_frames_minus1(self, ns, indices, arguments):
        return self.unit_frames - 1

    def _frame_crc(self, ns, indices, arguments):
        return None  # the right one

    def _frame_residual(self, ns, indices, arguments):
        return self.residual()

    def _num_patches(self, ns, indices, arguments):
        return self.numbers.pick([0, 0, self.numbers.between(1, min(5, ns["MaxClusters"]))])

    def _patch_mode(self, ns, indices, arguments):
        return self.numbers.between(0, 2)

    def _patch_residual(self, ns, indices, arguments):
        return self.residual()

    def _num_local_groups(self, ns, indices, arguments):
        return min(self.plan.local_groups, 255 - ns["num_component_groups"])

    def _track_levels(self, ns, indices, arguments):
        return self.numbers.pick([0, 1, 2, 3, self.numbers.between(0, 7)])

    def _num_temporal_layers_minus1(self, ns, indices, arguments):
        return self.near(0, ns["track_levels"])

    def _temporal_layer_idx(self, ns, indices, arguments):
        return self.temporal_layer

    def _rotation_between(self, ns, indices, arguments):
        return self.numbers.between(0, 2)

    _origin_between = _stretch_between = _temporal_between = _rotation_between

    def _trajectory_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(self.plan.present_percent))


def _offset(ns):
    """Offset of the entry of an explicit pattern that is being written."""
    return ns["pattern_offset_minus1"][-1] + 1


def _kept(ns):
    """The indices of the shared rigs that there are."""
    return [m for m, rig in enumerate(ns["SharedRigs"]) if rig]


class HighSequence(random_main.MainSequence):
    """The units of a random stream of the High profile."""

    version_minor = 2

    def _skippable(self):
        super()._skippable()
        if self._n.chance(10):
            self._unit("CLIP_TABLE")
        ns = self._writer.ns
        if (self._plan.attributes.percent and ns["HasAttributes"] == 0 and "Triangles" in ns
                and not self._writer.gof_frames and not self._writer.rig_indices
                and self._n.chance(self._plan.attributes.percent)):
            self._unit("ATTRIBUTES")

    def _gof(self):
        # R-IDX-05; where the end is open, the GOF that follows has a frame at least.
        ns = self._writer.ns
        maximum = ns["NumParsedFrames"] + 1 if self._plan.open_end else ns["NumFrames"]
        while (self._n.chance(self._plan.rigs_percent)
               and len(self._writer.rig_indices) < maximum):
            self._unit("RIG")
            self._slices()
            self._skippable()
        super()._gof()

    def _has_more(self):
        if not self._plan.open_end:
            return super()._has_more()
        parsed = self._writer.ns["NumParsedFrames"]
        return parsed == 0 or (parsed < 9 and self._n.chance(60))

    def _may_have_hash(self):
        return not (self._plan.open_end and self._writer.ns["gof_kind"] == 3)

    def _slices(self):
        ns = self._writer.ns
        if self._writer.source.unit_code == ns["GOF"] and ns["gof_kind"] == 3:
            return self._frames()
        if ns["HasVertices"] == 0:
            self._tracks()
        else:
            super()._slices()
        self._temporal_layers()

    def _frames(self):
        """The frame units of a GOF; from some frame on, fewer layer groups, or none."""
        ns, source = self._writer.ns, self._writer.source
        if ns["open_end_flag"] == 0:
            return self._units_in_any_order()
        maximum = [ns["num_layer_groups_minus1"] + 1] * (ns["temporal_layers_minus1"] + 1)
        place = -1
        while place + 1 < ns["NumGofFrames"]:
            place += 1
            frame = ns["FrameOrder"][place]
            layer = ns["TemporalLayerOfFrame"](frame)
            if self._n.chance(self._plan.cut_percent):
                maximum[layer] = self._n.between(0, maximum[layer])
                maximum[layer:] = [min(n, maximum[layer]) for n in maximum[layer:]]
            source.unit_frames = self._unit_frames(place)
            if maximum[layer] > 0:
                place += source.unit_frames - 1
            for group in range(maximum[layer]):
                if group > 0 and not ns["FramesToCome"]:
                    break
                if group > 0:
                    frame, source.unit_frames = ns["FramesToCome"][0], len(ns["FramesToCome"])
                source.slice = frame, group
                self._unit("FRAME")
            # The order stays if no period is cut off.
            if (self._n.chance(10) and place + 1 < ns["NumGofFrames"]
                    and sorted(ns["FrameOrder"][:place + 1]) == list(range(place + 1))
                    and place % ns["PatternPeriod"] == 0):
                source.slice, source.ends_gof = (place + 1, 0), True
                self._unit("FRAME")
                source.ends_gof = False
                break

    def _units_in_any_order(self):
        """Units of temporal layers and layer groups, each after what it needs; some left out."""
        ns, source = self._writer.ns, self._writer.source
        groups = range(ns["num_layer_groups_minus1"] + 1)
        layers = range(ns["temporal_layers_minus1"] + 1)
        left = {(t, g): [p for p, f in enumerate(ns["FrameOrder"])
                         if ns["TemporalLayerOfFrame"](f) == t] for t in layers for g in groups}
        while True:
            for g in groups[1:]:
                for t in layers:
                    left[t, g] = [p for p in left[t, g] if not ns["IsWhole"](ns["FrameOrder"][p])]
            ready = {key: self._ready(left, *key) for key in left if left[key]}
            ready = {key: places for key, places in ready.items() if places}
            if not ready:
                return
            layer, group = self._n.pick(list(ready))
            first = left[layer, group][0]
            if self._n.chance(self._plan.cut_percent):
                for t, g in left:
                    if t >= layer and g >= group:
                        left[t, g] = [p for p in left[t, g] if p < first]
                continue
            count = len(ready[layer, group])
            source.unit_frames = self._n.between(1, 1 if self._n.chance(50) else count)
            source.slice = ns["FrameOrder"][first], group
            self._unit("FRAME")
            del left[layer, group][:source.unit_frames]

    def _ready(self, left, layer, group):
        """The first places left of a temporal layer whose units of a layer group can come next."""
        ns = self._writer.ns
        end = min((left[t, group][0] for t in range(layer) if left[t, group]),
                  default=ns["NumGofFrames"])
        places = []
        for place in left[layer, group]:
            if place >= end or ns["FrameGroups"][ns["FrameOrder"][place]] != group:
                break
            places.append(place)
        return places

    def _unit_frames(self, place):
        """Number of frames in a unit that begins at a place."""
        ns = self._writer.ns
        if self._n.chance(50):
            return 1
        layers = [ns["TemporalLayerOfFrame"](f) for f in ns["FrameOrder"][place:]]
        run = next((i for i, layer in enumerate(layers) if layer != layers[0]), len(layers))
        return self._n.between(1, run)

    def _temporal_layers(self):
        """The slices of the temporal layers but the first, some of them cut off."""
        ns = self._writer.ns
        for layer in range(1, ns["num_temporal_layers_minus1"] + 1):
            self._writer.source.temporal_layer = layer
            for group, present in enumerate(list(ns["TemporalLayers"])):
                if present != layer or self._n.chance(self._plan.cut_percent):
                    break
                self._slice(group, 0)
        self._writer.source.temporal_layer = 0

    def _tracks(self):
        ns = self._writer.ns
        layers = ns["RigLayers"]
        first_local = ns["num_component_groups"] + 1
        for group in range(1, first_local):
            if layers[group] == 0 or self._n.chance(self._plan.cut_percent):
                return
            self._slice(group, 0)
        self._groups(range(first_local, first_local + ns["num_local_groups"]),
                     layers[first_local - 1])


class HighBuilder(random_streams.RandomBuilder):
    def __init__(self, program):
        super().__init__(program, HighPlan, HighSource, HighSequence)


def builder_of(profile):
    """The class that builds random streams of a profile, by the name that sidecars have for it."""
    return {"baseline": random_streams.RandomBuilder, "main": random_main.MainBuilder,
            "high": HighBuilder}[profile]
