"""Numbers published in the COBRA paper (Vasa and Skala 2009). The entropies of its table 1 and the
errors of its figures are of animations and quantisation constants that it does not give."""

BASIS_SAVED = 0.90  # share of the basis, against 64 bits per value
TOTAL_SAVED = 0.25  # share of everything, "approximately"
MAX_SAVED = 0.50  # share of everything, "up to more than"
MAX_BASIS = 0.50  # share of the basis in everything, at most, if it is coded directly
DIRECT_BITS = 64  # per value
KG_OF_PARTS = 0.3  # figure 12
NO_EFFECT = 10  # the vector from which on a uniform step can be tripled "with virtually no effect"
