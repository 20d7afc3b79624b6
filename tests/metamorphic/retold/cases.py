"""Which verification cases and examples are told in other words, and what is known of each."""

import dataclasses

# Round-off of another frame or order grows to this part of the largest motion in some thousand cycles.
EXACT = {"turned": 1e-8, "quarter": 1e-8, "mirrored": 1e-8, "renumbered": 1e-8, "millimetres": 1e-8, "powers_of_two": 1e-12, "moved": 1e-8, "drifting": 1e-8,
         "restarted": 0.0}  # fmt: skip
NEAR = ["sliced", "split", "declared"]


@dataclasses.dataclass
class Retold:
    often: list  # words that are told without `all`
    more: list = dataclasses.field(default_factory=list)  # words that name a block of this case
    # Another bound of the motion, or None: it is only reported; with the reason. `why` of words whose own checks are reported only.
    bounds: dict = dataclasses.field(default_factory=dict)
    other: dict = dataclasses.field(default_factory=dict)
    base: bool = True  # whether the original runs as well without `all`, to compare motions

    def words(self, everything):
        return [*EXACT, *NEAR, *self.more] if everything else self.often


STIFFER = "a strip one element wide: its triangles bend with the shear wave, and are not a mirror image of themselves"
DASHPOTS = "contact damping is a fraction of critical for the masses that a plane sees, which are those of other nodes"
WALL = 1e-6  # bricks on dry joints: stick or slip is decided again and again, and round-off grows

CASES = {
    "V10_dynamic_patch": Retold(["renumbered"], base=False),
    "V12_V13_one_joint": Retold(["quarter", "restarted", "millimetres"], ["refined:lower", "refined:upper"]),
    "V14_incline": Retold(["drifting", "cut:slab:0:3"], ["cut:slab:0:2", "cut:slab:0:3", "refined:slab"]),
    "V15_stick_slip": Retold(["mirrored"], ["cut:slab:0:3", "refined:slab"], base=False),
    "V19_hertz_line": Retold(["quarter"], ["cut:flat:0:3"], base=False),
    "V21_equal_bars": Retold(["restarted"], ["cut:right:1:2", "refined:left"], base=False),
    "V23_unequal_bars": Retold(["powers_of_two", "refined:left"], ["cut:left:1:3", "refined:left", "refined:right"]),
    "V24_rebound": Retold(["turned", "moved", "sliced", "declared", "cut:slab:0:3"], ["cut:slab:0:3", "refined:slab", "refined:block"],
                          other={"split": DASHPOTS, "refined:slab": DASHPOTS, "refined:block": DASHPOTS}),
    "V25_joint_wave": Retold(["mirrored"], ["refined:right"], base=False),
    "V26_joint_set": Retold(["quarter"], base=False),
    "V28_frictional_slip": Retold(["moved", "sliced", "millimetres"], ["refined:left"], other={"split": STIFFER}),
    "V30_eccentric_collision": Retold(["turned", "powers_of_two"], ["refined:second"], other={"drifting": "work of nodal forces is rounded as energies seen from 100 m/s are"}),
    "V32_spinning_pair": Retold(["mirrored", "split"], ["refined:left"]),
    "V51_rocking_block": Retold(["turned"], ["cut:floor:0:3"], base=False),
    "V52_topple_or_slide": Retold(["renumbered", "split"], ["cut:slab:0:2", "cut:slab:0:7", "refined:slab"]),
    "V53_arch": Retold(["mirrored"], base=False),
    "V57_ball_on_wall": Retold(["turned", "drifting", "renumbered", "powers_of_two", "declared", "restarted"], ["cut:base:0:3", "refined:ball", "refined:base"],
                               bounds={"turned": WALL, "moved": WALL}),
    "V64_life_of_planes": Retold([], ["cut:slab:0:2", "cut:slab:0:4"], base=False),
    "sharp_contacts": Retold([], ["refined:slab", "refined:plate"], base=False),
}
