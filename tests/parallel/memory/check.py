"""What a rank holds does not grow with the elements of others: bars of 16 x 16 x 64 P elements, cut across, on P = 4 and 8 ranks."""

from coplanetest import Case

ELEMENTS = 16 * 16 * 64  # of a rank

case = Case("memory", __file__)
deck = {
    "materials": {"stone": {"model": "linear_elastic", "density": 2500, "youngs_modulus": 1e9, "poisson_ratio": 0.25}},
    "blocks": {"bar": {"material": "stone"}},
    "time": {"end": 2.5e-6, "fixed_step": 1e-6},
    "output": {"results": "none", "planes": False},
    "contact": {"enabled": False},
    "partition": {"method": "rcb"},
}


def peak(name, layers, ranks):
    """Largest resident memory of a rank, the least of three runs [bytes]: what MPI and the system take besides differs from run to run by as
    much as 20 bytes for each element of others."""
    recipe = {"dimension": 3, "parts": [{"shape": "box", "block": "bar", "min": [0, 0, 0], "max": [16, 16, layers], "divisions": [16, 16, layers]}]}
    found = []
    for turn in (1, 2, 3):
        run = case.attempt(f"{name}, turn {turn}", recipe, deck, ranks, 1, "serial")
        case.check_equal(f"{name}, turn {turn}: exit code", run.code, 0)
        found.append(run.record["peak_memory_bytes"]["largest_rank"])
    return min(found)


def elements_alone(ranks):
    """Over a run of few elements on so many ranks: MPI takes more on more ranks."""
    return peak(f"{ranks} ranks", 64 * ranks, ranks) - peak(f"{ranks} ranks with little", ranks, ranks)


four, eight = elements_alone(4), elements_alone(8)
case.check_within("bytes for each own element on 4 ranks", four / ELEMENTS, 200, 3000)
# Ranks that held the whole mesh while they read it took 80 here, where the peak comes later.
case.check_within("bytes for each element of others", (eight - four) / (4 * ELEMENTS), -75, 75)
case.finish()
