"""The codecs of the comparison and how to run them, as tables: the only place to change them."""

import dataclasses
import pathlib
import re
import shlex
import shutil
import string
import subprocess

# In commands: {mesh}, {points}: the input; {gof}; {setting}: a step of the ladder, in words;
# {file}: what is to be measured; {order}: order map; {raw}: a file between two steps;
# {out}: decoded point cache. A step is run as one process.
RLPC_ENCODE = ("rlpcenc {mesh} --points {points} -o {file} --order-map {order} --gof {gof} "
               "--no-attributes --quiet {setting}",)
DEFAULT_GOF_ENCODE = tuple(step.replace("--gof {gof} ", "") for step in RLPC_ENCODE)
RLPC_DECODE = ("rlpcdec {file} -o {out} --quiet",)
XZ, ZSTD = "--lzma2=preset=9e,lc=4,pb=0", "--ultra -22"

COMPONENTS = (2, 3, 4, 5, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50, 60, 80, 120, 160, 240, 320)
PAPER = "--profile baseline --frame lcf --qu 12 --qc 12 --qdelta 12 --clusters {clusters}"


@dataclasses.dataclass(frozen=True)
class Codec:
    name: str  # name in --codecs
    title: str  # name in tables
    colour: str
    what: str  # for people who read the results
    encode: tuple = RLPC_ENCODE
    decode: tuple = RLPC_DECODE
    prepare: tuple = ()  # not timed, and its output is not counted
    options: str = ""  # come before every setting
    ladders: tuple = ()  # settings, coarse to fine; none: "--kg X" for every error asked for
    restores_order: bool = False  # the decoder does: no order map for the comparison
    line: str = "solid"
    is_shell: bool = False  # commands of the user, run by sh

    def files(self):
        """The files named by commands of the user; results depend on them, too."""
        if not self.is_shell:
            return []
        words = [word for step in self.encode + self.decode for word in shlex.split(step)]
        found = {str(pathlib.Path(path).resolve()) for path in map(shutil.which, words) if path}
        found |= {str(path.resolve()) for path in map(pathlib.Path, words) if path.is_file()}
        return sorted(found)

    @property
    def has_gof(self):
        return any("{gof}" in step for step in self.encode)

    @property
    def tools(self):
        if self.is_shell:
            return []
        return sorted({step.split()[0] for step in self.prepare + self.encode + self.decode})


def peer(name, title, colour, what, packer=None):
    """A codec of peer_codec, and what packs its file."""
    codec = name.split("-")[0]
    encode = f"peer_codec encode {codec} {{mesh}} {{points}} --bits {{setting}} -o "
    decode = f"peer_codec decode {codec} {{raw}} --order-map {{order}} -o {{out}}"
    steps = {
        None: ((encode + "{file}",), (decode.replace("{raw}", "{file}"),)),
        "xz": ((encode + "{raw}", f"xz -k -S .packed {XZ} {{raw}}"),
               ("xz -d -k -S .packed {file}", decode)),
        "zstd": ((encode + "{raw}", f"zstd -q {ZSTD} {{raw}} -o {{file}}"),
                 ("zstd -q -d {file} -o {raw}", decode)),
    }[packer]
    return Codec(name, title, colour, what, *steps,
                 prepare=(f"peer_codec order {codec} {{mesh}} {{points}} -o {{order}}",),
                 ladders=(tuple(str(bits) for bits in range(2, 17)),), restores_order=True)


def paper(name, title, colour, what, options, clusters=(10, 30)):
    return Codec(name, title, colour, what, ladders=tuple(
        tuple(f"{PAPER.format(clusters=n)} {options} --components {count}" for count in COMPONENTS)
        for n in clusters))


MAIN = Codec("main", "Main", "#111111", "RLPC, profile Main", options="--profile main")
HIGH = Codec("high", "High", "#b2182b", "RLPC, profile High (in preparation)",
             options="--profile high")
COBRA = ("--prediction parallelogram --bones 1 --influences 1 --no-temporal-weights "
         "--basis-steps cobra")

CODECS = (
    MAIN,
    Codec("main-fast", "Main, fast", "#777777", "the same, --preset fast",
          options="--profile main --preset fast", line="dashed"),
    Codec("main-slow", "Main, slow", "#444444", "the same, --preset slow",
          options="--profile main --preset slow", line="dashed"),
    Codec("main-gofs", "Main, default GOFs", "#333333", "the same, without --gof",
          encode=DEFAULT_GOF_ENCODE, options="--profile main", line="dashed"),
    HIGH,
    Codec("high-fast", "High, fast", "#ef8a62", "the same, --preset fast",
          options="--profile high --preset fast", line="dashed"),
    Codec("high-slow", "High, slow", "#67001f", "the same, --preset slow",
          options="--profile high --preset slow", line="dashed"),
    Codec("high-gofs", "High, default GOFs", "#d6604d", "the same, without --gof",
          encode=DEFAULT_GOF_ENCODE, options="--profile high", line="dashed"),
    Codec("baseline", "Baseline", "#0072b2", "RLPC, profile Baseline",
          options="--profile baseline"),
    paper("rlpca", "RLPCA", "#56b4e9",
          "Amjoun and Strasser 2007, at the paper's settings: profile Baseline, 12 bits, 10 or 30 "
          "clusters, as many components in each", "--no-rdo"),
    paper("orlpca", "RLPCA-RDO", "#009e73", "the same, components given by rate and distortion",
          "--rdo-rate vectors"),
    Codec("coddyac", "Coddyac + COBRA", "#d55e00",
          "Vasa and Skala 2007 and 2009, with our entropy coder: profile Main with "
          f"{COBRA}", options=f"--profile main {COBRA}"),
    peer("lorenzo-xz", "Lorenzo + xz", "#cc79a7",
         "differences in time (first or second, whichever is smaller) and from neighbours on the "
         f"mesh, xz {XZ}", "xz"),
    peer("meshopt-zstd", "meshopt + zstd", "#e69f00",
         f"differences in time, codecs of meshoptimizer, zstd {ZSTD}", "zstd"),
    peer("zfp-xz", "zfp + xz", "#8c564b",
         "zfp with an error bound, each axis an array of vertices and frames; triangles by "
         "xz", "xz"),
    peer("draco", "draco per frame", "#b8a800",
         "draco at its slowest, a mesh for each frame"),
)
DEFAULT = ("main", "baseline", "rlpca", "orlpca", "coddyac", "lorenzo-xz", "meshopt-zstd", "zfp-xz",
           "draco")
PEERS = ("coddyac", "lorenzo-xz", "meshopt-zstd", "zfp-xz", "draco")
# In README.md: of the bundled animations, which are too short for several GOFs; of others.
README = ("main", "high", "baseline", *PEERS)
README_OTHERS = ("main", "main-gofs", "high", "high-gofs", "baseline", *PEERS)
NOT_PACKAGED = ("FAMC (MPEG-4 Part 16), SSLPC and SZ3 are not compared: Debian 12 does not package "
                "them.")


class BadCodec(Exception):
    """--codec asks for what cannot be run; the text says why."""


OWN_COLOURS = ("#6a3d9a", "#7fc11c", "#ff1493", "#00c8c8", "#3d2bff")  # unlike all above
# Placeholders, and those of which one must be used.
OWN_ENCODE = {"mesh", "points", "step", "file", "order"}, ({"file"}, {"mesh", "points"})
OWN_DECODE = {"file", "out", "order"}, ({"file"}, {"out"})


def _steps_of(text):
    """2..16: integers; else a list, separated by commas."""
    first_last = re.fullmatch(r"(-?\d+)\.\.(-?\d+)", text)
    if not first_last:
        return tuple(word for word in text.split(",") if word)
    first, last = map(int, first_last.groups())
    way = 1 if first <= last else -1
    return tuple(map(str, range(first, last + way, way)))


def _check_command(what, command, known, needed):
    try:
        used = {name for _, name, _, _ in string.Formatter().parse(command) if name is not None}
        shlex.split(command)
    except ValueError as error:
        raise BadCodec(f"{what}: {error} (double the braces of the command itself)") from error
    for name in sorted(used - known):
        raise BadCodec(f"{what}: unknown {{{name}}}; use "
                       + ", ".join(f"{{{k}}}" for k in sorted(known)))
    for choice in needed:
        if not used & choice:
            raise BadCodec(f"{what}: {' or '.join(f'{{{k}}}' for k in sorted(choice))} is missing")


def own_codec(name, encode, decode, steps, number):
    """The codec of the number-th --codec."""
    if not re.fullmatch(r"[\w.+-]+", name):
        raise BadCodec(f"{name}: a name has letters, digits and . + - _ only")
    if name in {codec.name for codec in CODECS}:
        raise BadCodec(f"{name}: is the name of a built-in codec")
    _check_command(f"{name}, encode", encode, *OWN_ENCODE)
    _check_command(f"{name}, decode", decode, *OWN_DECODE)
    ladder = _steps_of(steps)
    if not ladder:
        raise BadCodec(f"{name}: no steps")
    if "{step}" not in encode and len(ladder) > 1:
        raise BadCodec(f"{name}, encode: {{step}} is missing, but there are {len(ladder)} steps")
    what = f"`{encode}` and `{decode}`, steps {steps}"
    return Codec(name, name, OWN_COLOURS[number % len(OWN_COLOURS)], what, (encode,), (decode,),
                 ladders=(ladder,), is_shell=True)


def variant(name, title, colour, options, profile="Main"):
    return Codec(name, title, colour, f"{profile} with {options}",
                 options=f"--profile {profile.lower()} {options}")


# Loss of a profile without one of its tools. The encoder tries cluster GOFs only if no tool is
# disabled; so all rows are without them, and compared with the row that only disables clusters.
MAIN_ABLATIONS = (
    MAIN,
    variant("clusters", "Main, no clusters", "#000000", "--no-clusters"),
    variant("prediction-none", "no prediction over the mesh", "#0072b2", "--prediction none"),
    variant("parallelogram", "parallelogram", "#56b4e9", "--prediction parallelogram"),
    variant("parallelograms", "mean of parallelograms", "#009e73", "--prediction parallelograms"),
    variant("outer-ring", "no outer ring", "#d55e00", "--no-outer-ring"),
    variant("geometry-weights", "no geometry weights", "#cc79a7", "--no-geometry-weights"),
    variant("layer-steps", "no layer steps", "#e69f00", "--no-layer-steps"),
    variant("temporal-weights", "no temporal weights", "#8c564b", "--no-temporal-weights"),
    variant("bones", "one bone", "#b8a800", "--bones 1"),
    variant("basis-steps", "basis steps as COBRA", "#777777", "--basis-steps cobra"),
)
# The tools that High has beyond Main. Its shared rigs show in short GOFs: compare --gof all,64.
HIGH_ABLATIONS = (
    HIGH,
    variant("clusters", "High, no clusters", "#000000", "--no-clusters", "High"),
    variant("adaptive-weights", "no adaptive weights", "#0072b2", "--adaptive-factors 0", "High"),
    variant("rest", "rest positions as in Main", "#009e73", "--rest prediction", "High"),
    variant("counterparts", "no counterparts", "#56b4e9", "--rest order", "High"),
    variant("track-levels", "sequential tracks", "#d55e00", "--track-levels 0", "High"),
)
ABLATIONS = {"main": MAIN_ABLATIONS, "high": HIGH_ABLATIONS}


class Toolbox:
    """The folder of the programs, and what they can do."""

    OWN = ("rlpcenc", "rlpcdec", "rlpccmp", "rlpcinfo", "peer_codec", "plot_svg", "make_tentacle")

    def __init__(self, folder):
        self.folder = folder
        self._said = {}

    def path(self, tool):
        """The path of a program, or None. Our own tools are looked for in the folder only."""
        if tool not in self.OWN:
            return shutil.which(tool)
        own = self.folder / tool
        return str(own) if own.is_file() else None

    def _says(self, *command):
        if command not in self._said:
            self._said[command] = subprocess.run(
                [self.path(command[0]), *command[1:]], capture_output=True, text=True,
                check=False).stdout
        return self._said[command]

    def how_to_build(self, tool):
        build = shlex.quote(str(self.folder.parent))
        if (self.folder.parent / "CMakeCache.txt").is_file():
            return f"run `cmake {build} && cmake --build {build} --target {tool}`"
        return "leave out --bin to have it built"

    def not_there(self, tool):
        """Why a tool is missing, and the remedy."""
        if tool in self.OWN:
            return f"is not in {self.folder}; {self.how_to_build(tool)}"
        return "is not installed; run scripts/setup --compare"

    def missing(self, codec):
        """Why the codec cannot be run here, and the remedy; None: it can."""
        for tool in codec.tools:
            if self.path(tool) is None:
                return f"{tool} {self.not_there(tool)}"
        if "peer_codec" in codec.tools:
            kind = codec.encode[0].split()[2]
            if kind not in self._says("peer_codec", "list").split():
                return ("peer_codec was built without the library; run scripts/setup --compare, "
                        f"then {self.how_to_build('peer_codec')}")
        if "rlpcenc" in codec.tools:
            known = self._says("rlpcenc", "--help-all")
            asked = " ".join((codec.options, *(s for ladder in codec.ladders for s in ladder[:1])))
            for word in asked.split():
                if word.startswith("--") and not re.search(rf"{word}(?![\w-])", known):
                    return f"this rlpcenc has no {word}"
        return None
