"""Parts of the papers that are not reproduced, and why: for researchers who look for them."""

_OTHERS = ("Other methods of the paper's comparisons ({}): no implementation is at hand, and what "
           "the papers print of them is not enough to write one that could be trusted.")

_RLPCA = (
    _OTHERS.format("AWC, TLS, TG, KG and CPCA, except for its published numbers"),
    "Figure 5, decoded frames of three methods side by side: not drawn. Decode streams with the "
    "settings of the report (rlpcdec -o frame_%04d.obj) and render them.",
    "The bounding box of each frame, by which positions of seeds are quantised: not reproduced, as "
    "the format has one step for all seed tracks of a GOF. It matters where the animation changes "
    "its size.",
    "Clusters carried from one GOF to the next: the whole sequence is one group of frames, as in "
    "the paper, and the Baseline profile makes new clusters for each GOF.",
    "That RLPCA suits meshes of many vertices, unlike KG: not tested, as this needs KG's coder, "
    "and sequences of several sizes.",
    "Times are not comparable: computers differ, and so do the parts that are counted.",
)
_SSLPC = (
    _OTHERS.format("FPC, TWC, AWC, Dynapack, and CPCA except for its published numbers"),
    "Curves of figure 5: published without numbers, so that only what the paper says of them is "
    "compared.",
    "Base layer, quantiser and entropy coder of the paper: not reproduced; they are those of the "
    "format, as the layers are.",
    "Spatial layers without overhead: not reached. Frames cannot share units with groups of "
    "layers, so that unit headers are most of the overhead (see the claims), and a group ends "
    "where a layer ends, so that cuts cannot be placed as in the paper. Both would need other "
    "syntax.",
)
_COBRA = (
    _OTHERS.format("FAMC, CPCA, and the paper's own entropy coder"),
    "The power curve of (20) to (22), which sends all steps as a few numbers: not reproduced, as "
    "the format sends a step for each vector.",
    "Numbers of table 1 and of figures 6 to 8 and 12: published for animations, and with "
    "quantisation constants, that the paper does not give, so that only what it concludes from "
    "them is compared.",
    "A summary over animations: run one report for each; what the claims say is not averaged, as "
    "sequences decide more than methods do.",
)
_REGISTRATION = (
    _OTHERS.format("those of table 3"),
    "ICP: not needed, as vertices correspond by index.",
    "Lloyd's clusters for each mesh, re-partition of patches with large errors, and regrouping of "
    "vertices in each frame: not reproduced, as the format has one partition per GOF. Symbols P, "
    "N, E and D of each vertex are replaced by a mode of each patch in each frame, and residuals.",
    "Recursive spectral cuts, and a number of clusters that follows from the mesh: not reproduced; "
    "k eigenvectors are clustered at once, and the number is that of table 1, or half of k-way's.",
    "I meshes where motion is fast: not inserted. Inter GOFs have equal lengths, and here the "
    "whole sequence is one; only the automatic mode of the Main and High profiles ends GOFs by "
    "their content.",
    "Bits by a PSNR threshold: there is no such target. The error of each stream is searched for "
    "until its mean PSNR is that of the paper.",
    "Figure 10 and the thresholds of table 4: types are chosen by cost, for the quality of the "
    "whole stream, and there is no threshold tau. Table 4 is compared at its PSNR.",
    "Face, Chicken and Dance: compared only if they are given.",
)
_PAPERS = {"rlpca": _RLPCA, "sslpc": _SSLPC, "cobra": _COBRA, "registration": _REGISTRATION}


def of(paper):
    """Sentences."""
    return list(_PAPERS[paper])
