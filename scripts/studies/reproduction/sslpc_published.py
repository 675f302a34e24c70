"""Table 1 of the SSLPC paper (Stefanoski, Liu, Klie and Ostermann 2007), and what it says."""

import dataclasses

import models
import rlpca_published


@dataclasses.dataclass(frozen=True)
class Decomposition:
    """Vertices of each spatial layer, from the base on. `lossless`: the KG error of a sequence that
    the paper calls lossless with regard to visual quality. `large`: that above which it states
    gains."""
    model: models.Model
    layers: tuple
    lossless: float
    large: float

    @property
    def growth(self):
        return growth(self.layers)


def growth(layers):
    """Vertices of each layer against all below it; the base has none."""
    return [None, *(size / sum(layers[:i + 1]) for i, size in enumerate(layers[1:]))]


CHICKEN = Decomposition(models.CHICKEN, (318, 103, 166, 221, 299, 442, 600, 881), 0.02, 0.08)
# The paper states gains at large errors for the chicken alone; for others, they are as large
# against the lossless one.
COW = Decomposition(models.COW, (593, 225, 290, 423, 554, 819), 0.15,
                    0.15 * CHICKEN.large / CHICKEN.lossless)

GROWTH = 0.38  # "about 38 %" per layer


def decomposition_of(model):
    """Settings of a sequence; sequences that are not in the paper have those of its cow."""
    return CHICKEN if model is models.CHICKEN else COW


def cpca(model):
    """Figure 5 has the rates of CPCA; those known as numbers are in the RLPCA paper: (bpvf, KG
    error), each once. model: None if the paper has none."""
    return tuple(dict.fromkeys(row.cpca[:2] for row in rlpca_published.TABLE
                               if row.model is model and model in (models.CHICKEN, models.COW)))
