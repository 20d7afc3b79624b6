"""A soft block that is pressed on a slab of the same, deep for its elements, and slid."""


def slid_block(ratio, slide, friction, block=(4, 3), slab=(21, 3), dimension=2, split=None, element="one_point", step_factor=0.8):
    """Recipe and deck. Both are 0.1 m high, the block 0.2 m wide; they are pressed to `ratio` of the height of the block in the first half of the
    run, and the top of the block is slid by `slide` [m] in the second. `block`, `slab`: elements along and up."""
    third, deep = ([0.1], ([2], [3])) if dimension == 3 else ([], ([], []))
    low = [0.0] * len(third)
    parts = [
        {"shape": "box", "block": "slab", "min": [-0.3, 0, *low], "size": [0.9, 0.1, *third], "divisions": [*slab, *deep[1]]},
        {"shape": "box", "block": "block", "min": [0.0, 0.1, *low], "size": [0.2, 0.1, *third], "divisions": [*block, *deep[0]]},
    ]
    for part in parts:
        part |= {"split": split} if split else {}
    recipe = {
        "dimension": dimension, "parts": parts,
        "node_sets": {"base": {"block": "slab", "where": {"y": 0}}, "top": {"block": "block", "where": {"y": 0.2}}},
    }  # fmt: skip
    deck = {
        "materials": {"rubber": {"model": "neo_hookean", "density": 1000, "youngs_modulus": 1e6, "poisson_ratio": 0.3}},
        "blocks": {name: {"material": "rubber", "element": element} for name in ("slab", "block")},
        "joints": {"touch": {"model": "penalty", "friction": friction}},
        "contact": {"default_joint": "touch"},
        "conditions": [
            {"type": "fixed", "node_set": "base"},
            {"type": "displacement", "node_set": "top", "value": [f"{slide}*max(0,min(t/0.2-1,1))", f"-{0.2 * (1 - ratio)}*min(t/0.2,1)", 0]},
        ],
        "damping": {"mass": 30},
        "time": {"end": 0.4, "step_factor": step_factor},
        "output": {"every": 0.4, "planes": False},
        "history": {"every": 0.002, "joints": ["touch"]},
    }  # fmt: skip
    return recipe, deck
