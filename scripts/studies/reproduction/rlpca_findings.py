"""Tests the claims of the RLPCA paper on the runs of a reproduction (rlpca.Reproduction)."""

import arithmetic
import claims
import rlpca_claims as rlpca
import rlpca_paths

BITS, FINE_BITS = 12, 16
COUNTS = (10, 20, 30)  # numbers of clusters


def _seed_rates(made):
    """(bits, N, bpvf of seeds) at 12 and 16 bits."""
    rates = []
    for bits in (BITS, FINE_BITS):
        for clusters in (10, 30):
            settings = made.settings("RLPCA", clusters, 10)
            settings[settings.index("--qdelta") + 1] = bits
            rates.append((bits, clusters, made.bench.info(settings)["bits"]["seed tracks"]
                          / made.sequence.size))
    return rates


def _at_settings(made):
    """Claims about pairs of runs."""
    def all_of(method):
        return [run for n in COUNTS for run in made.curves[method, n]]

    def pairs(better, worse):
        return [(f"N = {n}", made.curves[better, n], made.curves[worse, 1 if worse == "PCA" else n])
                for n in COUNTS]

    return [
        rlpca.equal_settings("local coordinates have a smaller error than world coordinates, at "
                             "equal N and L", all_of("RLPCA"), all_of("LPCA")),
        claims.equal_rate("local coordinates take fewer bits than world coordinates, "
                          "at equal error", pairs("RLPCA", "LPCA")),
        rlpca.equal_settings("distributing components by rate and distortion lowers the error, at "
                             "equal N and L", all_of("ORLPCA"), all_of("RLPCA")),
        claims.equal_rate("distributing components by rate and distortion takes fewer bits, at "
                          "equal error", pairs("ORLPCA", "RLPCA")),
        claims.equal_rate("RLPCA takes fewer bits than PCA, at equal error", pairs("RLPCA", "PCA")),
    ]


def _of_frames(methods, settings):
    return [
        rlpca.frame_by_frame("in each frame, RLPCA has a smaller error than LPCA, N = L = 10",
                             methods["RLPCA"], methods["LPCA"]),
        rlpca.frame_by_frame("in each frame, ORLPCA has a smaller error than RLPCA, N = L = 10",
                             methods["ORLPCA"], methods["RLPCA"]),
        rlpca.frame_by_frame("in each frame, more components lower the error, N = 20, L = 20 "
                             "against 10", settings["(20, 20)"], settings["(20, 10)"]),
        rlpca.frame_by_frame("in each frame, more clusters lower the error, L = 10, N = 20 against "
                             "10", settings["(20, 10)"], settings["(10, 10)"]),
    ]


def at_equal_rates(errors, runs):
    """Sentences on figure 6 (a). errors: of each frame; runs: at about the rate of RLPCA."""
    return [rlpca.frame_by_frame(
        f"in each frame, {better} has a smaller error than {worse} at about equal rates, N = "
        f"{runs[better].clusters}, {runs[better].bpvf:.2f} and {runs[worse].bpvf:.2f} bpvf",
        errors[better], errors[worse])
        for better, worse in (("RLPCA", "LPCA"), ("ORLPCA", "RLPCA"))]


def _ours(made):
    """Main and High against the best method of the paper."""
    items = []
    for name in ("Main", "High"):
        rates = [arithmetic.bd_rate(claims.curve(made.curves[name, 0]),
                                    claims.curve(made.curves["ORLPCA", n])) for n in COUNTS]
        rates = [rate for rate in rates if rate is not None]
        if rates:
            items.append(f"{name} takes {min(rates):+.0f} % to {max(rates):+.0f} % bits against "
                         "ORLPCA, at equal error.")
    return items


def claims_of_paper(made, methods, settings, paths):
    """Sentences. methods, settings: errors of each frame; paths: of figure 2."""
    coarse, fine = ([made.run("RLPCA", n, 10, bits) for n in (10, 30)]
                    for bits in (BITS, FINE_BITS))
    steadier = [rlpca_paths.spread(p.local) < rlpca_paths.spread(p.world) for p in paths]
    return [
        *_at_settings(made), *_of_frames(methods, settings),
        rlpca.quantiser(f"the error of {BITS} bits for eigenshapes and coefficients is negligible, "
                        f"against {FINE_BITS} bits", coarse, fine),
        rlpca.seeds("seeds take 0.01 to 1 bpvf with 12 to 16 bits", _seed_rates(made)),
        claims.counted("vertices vary less in local coordinates (RMS distance from their mean "
                       "position)", sum(steadier), len(steadier)),
        rlpca.best_count({n: made.curves["RLPCA", n] for n in COUNTS}),
        *_ours(made),
    ]


def against_published(made, rows):
    """Sentences. rows: of table 1 for this sequence (Reproduction.table)."""
    best = {method: [run for n in COUNTS for run in made.curves[method, n]]
            for method in ("RLPCA", "ORLPCA")}
    items = [claims.at_published_errors(f"our {method}, with the best of N = 10, 20, 30, takes "
                                        f"fewer bits than the published {theirs}, at its error",
                                        best[method], points)
             for method in ("RLPCA", "ORLPCA")
             for theirs, points in (("RLPCA", [(r.kg, r.bpvf) for r, *_ in rows]),
                                    ("CPCA", [(r.cpca[1], r.cpca[0]) for r, *_ in rows]))]
    return items + rlpca.published(rows)
