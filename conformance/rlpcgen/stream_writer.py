"""Writes streams by running the pseudo-code of the specification backwards.

The specification says how a syntax element is read; here every element is first written, with a
value that a source gives, and then read by the specification's own functions. So contexts,
conditions and order are those of the text, a new syntax element needs nothing here, and a value
that is not read back as it was written is noticed at once.
"""

import collections
import pathlib
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "specdec"))
import spec_program

from range_writer import RangeWriter

BIT_DESCRIPTORS = ("u", "ue", "se")
MAX_RESIDUAL = 268435455
_ESCAPE_LENGTH = 27  # most ones before the bits of an escape, 9.5.1

# Requirements on what follows an element, which is not yet written when they are evaluated.
_STRUCTURAL = ("R-UNT-01", "R-UNT-02", "R-RNG-01", "R-RNG-02", "R-HSH-01", "R-BIT-03", "R-MET-02")


class WriteError(Exception):
    """A value that cannot be written, or that the specification reads as another one."""


class _Stop(Exception):
    """The payload is to end here."""


def exp_golomb(value):
    """Bits of ue( ), as text."""
    zeros = (value + 1).bit_length() - 1
    return "0" * zeros + format(value + 1, "b")


class StreamWriter:
    """One stream. source.value(writer, name, indices, descriptor, arguments) gives the values."""

    def __init__(self, code, source, strict=False):
        """code: of writing_code( ). strict: a broken requirement is an error, not intended."""
        self.data = bytearray()
        self.source = source
        self.strict = strict
        self.broken = []  # rules, in the order in which they failed
        self.sections = []  # the RangeWriter of each section
        self.highest_end = False
        self.stop_broken = False  # a payload ends where it breaks a requirement
        self.alignment = "0"  # the bits that byte_alignment( ) is to find
        self._bins = collections.deque()
        self._range = None
        self._reading = False  # a payload that was given as bytes
        self.ns = spec_program.run(code, {
            "StreamBytes": self.data, "require": self._require, "supported": self._support,
            "inflates_to": lambda first, end, size: 1, "output_bytes": lambda data: None,
            "output_attributes": lambda data: None,
            "write_element": self._element})
        self._read = {name: self.ns[name] for name in
                      ("ae", "bypass", "byte_alignment", "CheckOverrun", "EndSection")}
        self.ns.update(ae=self._ae, bypass=self._bypass, byte_alignment=self._byte_alignment,
                       CheckOverrun=lambda: None, EndSection=self._end_section,
                       CheckHash=self._collect_hash, CheckFrameCrc=lambda f: None)
        self._watch_tracks()
        self.ns["StartReading"]()
        self.ns.update(MaxUnitBytes=0xFFFFFFFF, NumParsedFrames=0, NumOutputFrames=0,
                       HasConnectivity=0, HasVertexOrder=0, HashExpected=1, IndexWanted=1,
                       NumGofFrames=0, HasAttributes=0, WantsAsset=lambda: True,
                       WantsAttributes=lambda: "Triangles" in self.ns)
        self.ns["StartRigs"]()
        self.inferred = {}  # element -> value, or list of values, that fits what is written
        self.gof_frames = []  # num_gof_frames_minus1 of each GOF
        self.rig_indices = []  # rig_idx of each shared rig
        self._rig_pending = False  # a shared rig that is not decoded yet
        self.frame_hashes = []
        self.running_hash = 0
        self._num_crcs = 0  # hashes of frames in the unit
        self._crcs = []  # known once the unit has been written: (number, place)
        self._first_frame_crcs = []  # known from the whole stream: (bit position, unit)
        self._unit_start = 0
        self._decoded_frames = 0  # number of decoded frames of an inter GOF
        self._counts_gof = False  # the last GOF is in gof_frames

    # Bits.

    def put_bits(self, bits):
        position = self.ns["BitPosition"]
        for bit in bits:
            if position % 8 == 0:
                self.data.append(0)
            self.data[-1] |= int(bit) << (7 - position % 8)
            position += 1
        self.ns["ReadEnd"] = 8 * len(self.data)

    def put_bytes(self, data):
        self.data += data
        self.ns["BitPosition"] = self.ns["ReadEnd"] = 8 * len(self.data)

    def _byte_alignment(self):
        missing = -self.ns["BitPosition"] % 8
        self.put_bits((self.alignment * 8)[:missing])
        self._read["byte_alignment"]()

    # Sections.

    def _start_range(self):
        if self._range is None:
            self._range = RangeWriter()
            self.sections.append(self._range)

    def _decide(self, upper, call):
        """Lets the specification decide for one part of its range, by a Code that lies in it."""
        self._start_range()
        ns = self.ns
        before, position = ns["Range"], ns["SectionPosition"]
        ns["Code"] = before - 1 if upper else 0
        result = call()
        shifts = ns["SectionPosition"] - position
        self._range.narrow(before - (ns["Range"] >> (8 * shifts)) if upper else 0, shifts)
        return result

    def _ae(self, model):
        wanted = self._bins.popleft()
        return self._decide(wanted == 0, lambda: self._read["ae"](model))

    def _bypass(self, n):
        value = 0
        for _ in range(n):
            wanted = self._bins.popleft()
            value = 2 * value + self._decide(wanted == 1, lambda: self._read["bypass"](1))
        return value

    def _end_section(self):
        self._start_range()
        self.put_bytes(self._range.finish(self.ns["Range"], self.highest_end))
        self.ns["InSection"] = 0
        self._range = None

    # Elements.

    def _element(self, name, indices, descriptor, *arguments):
        if self._reading:
            return self.ns[descriptor](*arguments)
        value = self.source.value(self, name, tuple(indices), descriptor, arguments)
        if name == "frame_crc" and value is None:
            self._crcs.append((self._num_crcs, len(self.data)))
            value = 0
        if name == "first_frame_crc" and value is None:
            self._first_frame_crcs.append((self.ns["BitPosition"], self._unit_start))
            value = 0
        self._num_crcs += name == "frame_crc"
        if descriptor in BIT_DESCRIPTORS:
            self._put_code(name, value, descriptor, arguments)
        else:
            self._bins.extend(self._binarisation(name, value, descriptor, arguments))
        read = self.ns[descriptor](*arguments)
        expected = value
        if descriptor in ("ae_residual", "ae_header"):
            expected = max(-MAX_RESIDUAL, min(MAX_RESIDUAL, value))
        if read != expected or self._bins:
            raise WriteError(f"{name}: {value} was written, but {read} was read")
        return read

    def _put_code(self, name, value, descriptor, arguments):
        if descriptor == "u":
            if not 0 <= value < 1 << arguments[0]:
                raise WriteError(f"{name}: {value} does not fit u({arguments[0]})")
            self.put_bits(format(value, "b").zfill(arguments[0]) if arguments[0] else "")
            return
        if descriptor == "se":
            value = 2 * value - 1 if value > 0 else -2 * value
        if value < 0:
            raise WriteError(f"{name}: {value} is negative")
        self.put_bits(exp_golomb(value))

    def _binarisation(self, name, value, descriptor, arguments):
        if descriptor == "ae_residual":
            return self._residual_bins(value, arguments[1], len(arguments[0][0][0]))
        if descriptor == "ae_header":
            expected = self.ns["HeaderMean"][arguments[0]] >> 4
            return self._residual_bins(value, expected, len(self.ns["HeaderModels"][0][0]))
        if descriptor == "ae_unary":
            count = len(arguments[0])
            if not 0 <= value <= count:
                raise WriteError(f"{name}: {value} is not in the range of 0 to {count}")
            return [1] * value + [0] * (value < count)
        width = {"ae": 1, "bypass": arguments[0], "ae_tree": arguments[-1]}[descriptor]
        if not 0 <= value < 1 << width:
            raise WriteError(f"{name}: {value} does not fit {width} bins")
        return _digits(value, width)

    def _residual_bins(self, value, expected, longest):
        """9.5.1, from value to bins."""
        shift = self.ns["ResidualContext"](expected)[1]
        magnitude = abs(value)
        upper = magnitude >> shift
        bins = [1] * min(upper, longest)
        if upper < longest:
            bins.append(0)
        else:
            escape = upper - longest + 1
            length = escape.bit_length() - 1
            if length > _ESCAPE_LENGTH:
                raise WriteError(f"a residual of {value} is beyond all codes")
            bins += [1] * length + [0] * (length < _ESCAPE_LENGTH)
            bins += _digits(escape - (1 << length), length)
        bins += _digits(magnitude & ((1 << shift) - 1), shift)
        return bins + ([int(value < 0)] if magnitude else [])

    # Units.

    def stream_header(self, signature, version):
        """Signature and [version_major, version_minor]."""
        self.put_bytes(signature + bytes(version))
        self.ns["version_major"], self.ns["version_minor"] = version

    def _require(self, condition, rule):
        if condition or rule in _STRUCTURAL:
            return
        self.broken.append(rule)
        if self.strict:
            raise WriteError(f"{rule} is broken")
        if self.stop_broken:
            raise _Stop

    def _support(self, condition, rule):
        """After a profile and a version that do not match, the older of the two goes on.

        That is how released recipes write the rest of the sequence header.
        """
        self._require(condition, rule)
        if not condition and rule in ("R-HDR-01", "R-STR-03"):
            self.ns["profile_idc"] = min(self.ns["profile_idc"], self.ns["version_minor"])

    def unit(self, code, payload=None, finish=None):
        """A unit with the payload that the source gives, or with these bytes.

        finish(payload) can change the payload once it is written. A payload that breaks a
        requirement may be one that cannot be written to its end; it ends there.
        """
        ns = self.ns
        if code in (ns["GOF"], ns["RIG"]):
            self._finish_rig()
        if code == ns["GOF_INDEX"] and ns.get("open_end_flag"):
            ns["NumFrames"] = ns["NumParsedFrames"]  # the number that random access knows
        self.source.unit_code = code
        start = self._unit_start = len(self.data)
        ns["unit_header"]()
        ns["UnitCode"] = code
        if payload is not None:
            self._read_payload(payload)
        else:
            self._run_payload(code)
            if self._range is not None:
                self._end_section()
        self._bins.clear()
        if code == ns["GOF"]:
            self._decoded_frames = 0
            self._counts_gof = False
        elif code == ns["FRAME"]:
            self._end_gof_early()
        self._put_frame_crcs()
        if finish is not None:
            changed = finish(bytes(self.data[start + 5:]))
            del self.data[start + 5:]
            self.put_bytes(changed)
        self._close_unit(start)
        if code == ns["RIG"] and self._can_run(code):
            self._start_rig()

    def _run_payload(self, code):
        if not self._can_run(code):
            return
        try:
            self.ns["unit_payload"]()
        except _Stop:
            pass
        except (IndexError, KeyError, NameError, TypeError, ValueError) as error:
            if not self.broken:
                raise WriteError(f"unit of code {code}: {error!r}") from error

    def _watch_tracks(self):
        """Once a requirement is broken, tracks are reconstructed as soon as they are written.

        What cannot be reconstructed, such as a width below zero, ends the payload, as it did in
        the versions in which parsing reconstructed tracks: released recipes depend on that.
        """
        ns = self.ns
        bone_tracks, trajectory = ns["bone_tracks"], ns["trajectory"]
        reconstructed = 0  # bones of this GOF

        def written_bone(b):
            nonlocal reconstructed
            bone_tracks(b)
            if b == 0:
                reconstructed = 0
            if self.broken:
                if reconstructed == 0:
                    ns.update(IsStretched=[], BoneRotation=[], BoneAxes=[], BoneOrigin=[])
                for bone in range(reconstructed, b + 1):
                    ns["ReconstructBone"](bone)
                reconstructed = b + 1

        def written_trajectory():
            trajectory()
            if self.broken:
                ns["Trajectories"] = []
                ns["ReconstructTrajectory"](len(ns["TrajectoryTracks"]) - 1)

        ns.update(bone_tracks=written_bone, trajectory=written_trajectory)

    def _can_run(self, code):
        """Whether the unit is one that the version knows, and that can be read here."""
        if code < 128 and not self.ns["IsKnownType"](code):
            return False  # such as a slice in 1.0
        if code == self.ns["SLICE"]:
            return "SliceLayers" in self.ns  # after a GOF or shared rig
        if code == self.ns["FRAME"]:
            return "FrameGroups" in self.ns  # after an inter GOF
        if code == self.ns["RIG"]:
            return "EarlierNeighbours" in self.ns  # after the connectivity
        return True

    def _read_payload(self, payload):
        """Writes bytes as they are, and parses them, as later units depend on their contents."""
        ns, start = self.ns, self.ns["BitPosition"]
        self.put_bytes(payload)
        hooks = {name: ns[name] for name in self._read}
        ns.update(self._read, BitPosition=start)
        self._reading = True
        self._run_payload(ns["UnitCode"])
        self._reading = False
        ns.update(hooks, BitPosition=8 * len(self.data), InSection=0)

    def _close_unit(self, start):
        size = len(self.data) - start - 5
        claimed = self.source.override("unit_size", size)
        self.data[start + 1:start + 5] = claimed.to_bytes(4, "big")
        crc = self.source.override("unit_crc", zlib.crc32(self.data[start:]))
        self.put_bytes(crc.to_bytes(4, "big"))

    def _put_frame_crcs(self):
        """The hashes of the frames whose last frame unit has been written."""
        ns = self.ns
        for number, at in self._crcs:
            frame = ns["CodedFrames"][number]
            if ns["PlaceOfFrame"][frame] < self._decoded_frames:
                self._decoded_frames = 0  # it was absent when later ones were decoded
            while self._decoded_frames <= ns["PlaceOfFrame"][frame]:
                ns["NextPlace"] = self._decoded_frames
                ns["DecodeFrame"](ns["FrameOrder"][self._decoded_frames])
                self._decoded_frames += 1
            ns["NextPlace"] = 0  # decoding the GOF starts again
            ns["RoundFrame"](frame)
            crc = ns["HashOfPositions"](0)
            self.data[at:at + 4] = crc.to_bytes(4, "big")
            ns["FrameCrc"][frame][0] = crc
        self._crcs, self._num_crcs = [], 0

    def finish(self, program):
        """The whole stream, with the hash of its first frame wherever the source left it open."""
        if self._first_frame_crcs:
            crc = _hash_of_first_frame(program, bytes(self.data))
            for position, unit in self._first_frame_crcs:
                self._set_first_frame_crc(position, unit, crc)
        return bytes(self.data)

    def _set_first_frame_crc(self, position, unit, crc):
        """In the place of zeros; unit_crc changes as it must, or stays as wrong as it was."""
        end = unit + 5 + int.from_bytes(self.data[unit + 1:unit + 5], "big")
        before = zlib.crc32(self.data[unit:end])
        for bit in range(32):
            at = position + bit
            if at < 8 * end:
                self.data[at // 8] |= (crc >> (31 - bit) & 1) << (7 - at % 8)
        change = before ^ zlib.crc32(self.data[unit:end])
        written = int.from_bytes(self.data[end:end + 4], "big")
        self.data[end:end + 4] = (written ^ change).to_bytes(4, "big")

    def _start_rig(self):
        self.rig_indices.append(self.ns["rig_idx"])
        self._rig_pending = True

    def _finish_rig(self):
        """Before the next GOF or shared rig: GOFs can use this one."""
        if not self._rig_pending:
            return
        self._rig_pending = False
        try:
            self.ns["DecodeRig"]()
        except (IndexError, KeyError, NameError, TypeError, ValueError):
            if not self.broken:
                raise

    def _end_gof_early(self):
        """A frame unit may have set the number of frames of a GOF that has been counted."""
        if self._counts_gof:
            fewer = self.gof_frames[-1] + 1 - self.ns["NumGofFrames"]
            self.gof_frames[-1] -= fewer
            self.ns["NumParsedFrames"] -= fewer

    def decode_gof(self):
        """After a GOF unit: its frames count as parsed, and their hashes become known."""
        self._counts_gof = True
        self.ns["NumParsedFrames"] += self.ns["NumGofFrames"]
        self.gof_frames.append(self.ns["NumGofFrames"] - 1)
        self.frame_hashes, self.running_hash = [], 0

    def hash_of_gof(self, per_frame):
        """The hashes of the last GOF; decodes it when first asked."""
        if not self.frame_hashes:
            self.ns["HashPresent"] = 0
            try:
                self.ns["DecodeGof"]()
            except (IndexError, KeyError, TypeError, ValueError):
                if not self.broken:
                    raise
                self.frame_hashes = [0] * self.ns["NumGofFrames"]
        return self.frame_hashes if per_frame else [self.running_hash]

    def _collect_hash(self, frame):
        self.frame_hashes.append(self.ns["HashOfPositions"](0))
        self.running_hash = self.ns["HashOfPositions"](self.running_hash)


def _hash_of_first_frame(program, data):
    """FirstHash of the specification; 0 if decoding the stream gives no frame."""
    class Broken(Exception):
        pass

    def require(condition, rule):
        if not condition:
            raise Broken

    ns = program.compile({"StreamBytes": data, "require": require, "supported": require,
                          "inflates_to": lambda first, end, size: 1,
                          "output_bytes": lambda output: None,
                          "output_attributes": lambda output: None})
    try:
        ns["stream_with_attributes"]()
    except Broken:
        pass  # R-ATT-08 at the latest
    return ns.get("FirstHash", 0)


def _digits(value, width):
    return [(value >> (width - 1 - i)) & 1 for i in range(width)]
