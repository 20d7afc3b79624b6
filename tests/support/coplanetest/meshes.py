"""Meshes in memory, and the same bodies meshed or numbered otherwise, with what leads back to the first mesh.

A `Mesh` has points (node, axis), blocks, node sets and side sets. Every function takes one and returns another, whose `shares`, `parents` and
`sides_before` lead back: from nodes, elements and sides of the new mesh to those of the mesh it was made of.
"""

import dataclasses
import itertools
import typing

import netCDF4
import numpy

# Nodes of the sides of an element, from 0, as Exodus counts sides; by dimension and number of nodes.
SIDES = {
    (2, 3): [(0, 1), (1, 2), (2, 0)],
    (2, 4): [(0, 1), (1, 2), (2, 3), (3, 0)],
    (3, 4): [(0, 1, 3), (1, 2, 3), (0, 3, 2), (0, 2, 1)],
    (3, 8): [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7)],
}
KINDS = {(2, 3): "TRI3", (2, 4): "QUAD4", (3, 4): "TETRA4", (3, 8): "HEX8"}
# Nodes of the element seen in a mirror: the first two sides of its hand change places.
MIRRORED = {(2, 3): [1, 0, 2], (2, 4): [1, 0, 3, 2], (3, 4): [1, 0, 2, 3], (3, 8): [1, 0, 3, 2, 5, 4, 7, 6]}
# The corners of an 8-node element on a grid of 2 x 2 x 2, and of a 4-node one.
CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


class CannotTell(Exception):
    """This problem cannot be told in these words; the text says why."""


@dataclasses.dataclass
class Block:
    name: str
    id: int
    nodes: numpy.ndarray  # (element, corner), from 0
    attributes: dict = dataclasses.field(default_factory=dict)  # one value per element


@dataclasses.dataclass
class Mesh:
    points: numpy.ndarray
    blocks: list
    node_sets: dict  # nodes from 0, by name
    side_sets: dict  # (element from 0 over all blocks, side from 1), by name
    # Back to the mesh this one was made of: rows (node here, node there, weight); element there of each element here; and for each
    # element here and each of its sides, from 1, the side there, 0 for one inside.
    shares: typing.Optional[tuple] = None
    parents: typing.Optional[numpy.ndarray] = None
    sides_before: typing.Optional[numpy.ndarray] = None

    @property
    def dimension(self):
        return self.points.shape[1]

    @property
    def count(self):
        return sum(len(block.nodes) for block in self.blocks)

    def first(self, name):
        """Number of the first element of a block over all blocks."""
        found = 0
        for block in self.blocks:
            if block.name == name:
                return found
            found += len(block.nodes)
        raise KeyError(name)

    def as_it_is(self, **changes):
        """A copy that leads back to this mesh one to one."""
        n = len(self.points)
        plain = dict(shares=(numpy.arange(n), numpy.arange(n), numpy.ones(n)), parents=numpy.arange(self.count),
                     sides_before=numpy.tile(numpy.arange(7), (self.count, 1)))
        return dataclasses.replace(self, **{**plain, **changes})


# --- files -----------------------------------------------------------------------------------------------------------------------------


def _text(row):
    return b"".join(numpy.asarray(row).tolist()).split(b"\0")[0].decode()


def read(path):
    with netCDF4.Dataset(path) as file:
        file.set_auto_mask(False)

        def names(variable):
            return [_text(row) for row in file[variable][:]] if variable in file.variables else []

        points = numpy.stack([file[f"coord{axis}"][:] for axis in "xyz" if f"coord{axis}" in file.variables], axis=1)
        blocks = []
        for i, name in enumerate(names("eb_names"), start=1):
            nodes = file[f"connect{i}"][:].astype(int) - 1
            if (points.shape[1], nodes.shape[1]) not in KINDS:
                raise CannotTell(f"elements with {nodes.shape[1]} nodes")
            known = names(f"attrib_name{i}")
            attributes = {attribute: file[f"attrib{i}"][:, k] for k, attribute in enumerate(known)}
            blocks.append(Block(name, int(file["eb_prop1"][i - 1]), nodes, attributes))
        node_sets = {name: file[f"node_ns{i}"][:].astype(int) - 1 for i, name in enumerate(names("ns_names"), start=1)}
        side_sets = {name: numpy.stack([file[f"elem_ss{i}"][:].astype(int) - 1, file[f"side_ss{i}"][:].astype(int)], axis=1)
                     for i, name in enumerate(names("ss_names"), start=1)}  # fmt: skip
    return Mesh(points, blocks, node_sets, side_sets)


def write(mesh, path):
    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        for name, value in (("api_version", numpy.float32(8.12)), ("version", numpy.float32(8.12)), ("floating_point_word_size", numpy.int32(8)),
                            ("file_size", numpy.int32(1)), ("maximum_name_length", numpy.int32(255)), ("title", "told in other words")):  # fmt: skip
            file.setncattr(name, value)

        def dimension(name, size):
            file.createDimension(name, size)
            return name

        def variable(name, kind, dimensions, values):
            made = file.createVariable(name, kind, dimensions)
            made[:] = values
            return made

        def texts(name, count, words):
            rows = numpy.zeros((len(words), 256), "S1")
            for row, word in zip(rows, words):
                code = word.encode()
                row[: len(code)] = numpy.frombuffer(code, "S1")
            variable(name, "S1", (count, "len_name"), rows)

        dimension("len_name", 256)
        dimension("time_step", None)
        dimension("num_dim", mesh.dimension)
        nodes = dimension("num_nodes", len(mesh.points))
        dimension("num_elem", mesh.count)
        file.createVariable("time_whole", "f8", ("time_step",))
        for axis, values in zip("xyz", mesh.points.T):
            variable(f"coord{axis}", "f8", (nodes,), values)
        blocks = dimension("num_el_blk", len(mesh.blocks))
        variable("eb_status", "i4", (blocks,), 1)
        variable("eb_prop1", "i4", (blocks,), [block.id for block in mesh.blocks]).setncattr("name", "ID")
        texts("eb_names", blocks, [block.name for block in mesh.blocks])
        for i, block in enumerate(mesh.blocks, start=1):
            size = dimension(f"num_el_in_blk{i}", len(block.nodes)), dimension(f"num_nod_per_el{i}", block.nodes.shape[1])
            kind = KINDS[mesh.dimension, block.nodes.shape[1]]
            variable(f"connect{i}", "i4", size, block.nodes + 1).setncattr("elem_type", kind)
            if block.attributes:
                count = dimension(f"num_att_in_blk{i}", len(block.attributes))
                variable(f"attrib{i}", "f8", (size[0], count), numpy.stack(list(block.attributes.values()), axis=1))
                texts(f"attrib_name{i}", count, list(block.attributes))
        for short, long, sets in (("ns", "num_node_sets", mesh.node_sets), ("ss", "num_side_sets", mesh.side_sets)):
            if not sets:
                continue
            count = dimension(long, len(sets))
            variable(f"{short}_status", "i4", (count,), 1)
            variable(f"{short}_prop1", "i4", (count,), range(1, len(sets) + 1)).setncattr("name", "ID")
            texts(f"{short}_names", count, list(sets))
            for i, members in enumerate(sets.values(), start=1):
                size = (dimension(f"num_nod_ns{i}" if short == "ns" else f"num_side_ss{i}", len(members)),)
                if short == "ns":
                    variable(f"node_ns{i}", "i4", size, members + 1)
                else:
                    variable(f"elem_ss{i}", "i4", size, members[:, 0] + 1)
                    variable(f"side_ss{i}", "i4", size, members[:, 1])


# --- the same mesh in other words --------------------------------------------------------------------------------------------------------


def _side_numbers(dimension, corners, order):
    """For the sides, from 1, of an element whose corners stand in this order: the numbers they had before; place 0 is unused."""
    sides = SIDES[dimension, corners]
    before = {frozenset(side): number for number, side in enumerate(sides, start=1)}
    return [0] + [before[frozenset(order[corner] for corner in side)] for side in sides] + [0] * (6 - len(sides))


def moved(mesh, matrix, offset=(0, 0, 0), factor=1.0):
    """x -> factor (matrix x) + offset; a mirror also turns the order of the nodes of every element."""
    d = mesh.dimension
    points = mesh.points
    if not numpy.array_equal(matrix, numpy.eye(3)):
        points = points @ matrix[:d, :d].T
    points = points * factor + numpy.array(offset[:d], float)
    told = mesh.as_it_is(points=points)
    if numpy.linalg.det(matrix) < 0:
        told.blocks, rows = [], []
        for block in mesh.blocks:
            order = MIRRORED[d, block.nodes.shape[1]]
            told.blocks.append(dataclasses.replace(block, nodes=block.nodes[:, order]))
            rows += [_side_numbers(d, block.nodes.shape[1], order)] * len(block.nodes)
        told.sides_before = numpy.array(rows)
        told.side_sets = {name: _new_sides(members, told) for name, members in mesh.side_sets.items()}
    return told


def _new_sides(members, told):
    """Sides of a mesh with as many elements, whose children are told.parents: (element, side) of the new mesh."""
    if not len(members):
        return members
    wanted = {(int(e), int(s)) for e, s in members}
    elements = numpy.flatnonzero(numpy.isin(told.parents, members[:, 0]))
    found = [(e, side) for e in elements for side in range(1, 7) if (int(told.parents[e]), int(told.sides_before[e, side])) in wanted]
    return numpy.array(found)


def shuffled(number, seed=1):
    """Another number for each node."""
    return numpy.random.default_rng(seed).permutation(number)


def renumbered(mesh, seed=1):
    """Nodes, elements within their blocks, blocks and sets in random order."""
    random = numpy.random.default_rng(seed + 1)
    new = shuffled(len(mesh.points), seed)
    points = numpy.empty_like(mesh.points)
    points[new] = mesh.points
    order = random.permutation(len(mesh.blocks))
    if len(order) == 2:
        order = numpy.array([1, 0])
    blocks, parents = [], []
    for i in order:
        block = mesh.blocks[i]
        elements = random.permutation(len(block.nodes))
        blocks.append(Block(block.name, block.id, new[block.nodes[elements]], {name: values[elements] for name, values in block.attributes.items()}))
        parents.append(mesh.first(block.name) + elements)
    told = mesh.as_it_is(points=points, blocks=blocks, shares=(new, numpy.arange(len(new)), numpy.ones(len(new))), parents=numpy.concatenate(parents))
    told.node_sets = {name: numpy.sort(new[nodes]) for name, nodes in reversed(mesh.node_sets.items())}
    told.side_sets = {name: _new_sides(members, told) for name, members in reversed(mesh.side_sets.items())}
    return told


# --- the same bodies meshed otherwise ----------------------------------------------------------------------------------------------------


def cut(mesh, block, axis, parts):
    """A block in flush parts: nodes between elements on both sides of planes across an axis are there twice. The planes lie where grid lines
    do, as evenly as that goes.
    """
    chosen = next(b for b in mesh.blocks if b.name == block)
    x = mesh.points[:, axis]
    low, high = x[chosen.nodes].min(axis=1), x[chosen.nodes].max(axis=1)
    lines = numpy.unique(numpy.round(x[chosen.nodes], 9))[1:-1]
    lines = [line for line in lines if not numpy.any((low < line - 1e-8) & (high > line + 1e-8))]
    begin, end = low.min(), high.max()
    wanted = [begin + (end - begin) * i / parts for i in range(1, parts)]
    planes = sorted({min(lines, key=lambda line: abs(line - place)) for place in wanted}) if lines else []
    if len(planes) != parts - 1:
        raise CannotTell(f"block {block} has no {parts - 1} grid lines to be cut at")
    part = numpy.searchsorted(planes, (low + high) / 2)
    nodes, points = chosen.nodes.copy(), list(mesh.points)
    copies = {}  # node of the first part that uses it; others get one of their own
    owners, here, there = {}, list(range(len(points))), list(range(len(points)))
    for row, own in zip(nodes, part):
        for corner, node in enumerate(row):
            if owners.setdefault(int(node), int(own)) != own:
                key = int(node), int(own)
                if key not in copies:
                    copies[key] = len(points)
                    points.append(mesh.points[node])
                    here.append(copies[key])
                    there.append(int(node))
                row[corner] = copies[key]
    blocks = [dataclasses.replace(b, nodes=nodes) if b is chosen else b for b in mesh.blocks]
    told = mesh.as_it_is(points=numpy.array(points), blocks=blocks, shares=(numpy.array(here), numpy.array(there), numpy.ones(len(here))))
    twins = {}
    for (node, _), copy in copies.items():
        twins.setdefault(node, []).append(copy)
    told.node_sets = {name: numpy.array(sorted([*members, *(twin for node in members for twin in twins.get(int(node), []))]), int)
                      for name, members in mesh.node_sets.items()}  # fmt: skip
    # Attributes that number bodies would call all parts one body.
    for b in told.blocks:
        if b.name == block and "body_id" in b.attributes:
            b.attributes = {**b.attributes, "body_id": b.attributes["body_id"] + 1000 * part}
    return told


class _Growing:
    """A mesh whose elements become several: points that lie between nodes, each made once."""

    def __init__(self, mesh):
        self.mesh, self.points = mesh, list(mesh.points)
        n = len(mesh.points)
        self.shares = [(i, i, 1.0) for i in range(n)]
        self.made, self.corners = {}, {i: frozenset([i]) for i in range(n)}

    def between(self, nodes):
        """The node at the middle of these."""
        key = frozenset(int(node) for node in nodes)
        if len(key) == 1:
            return next(iter(key))
        if key not in self.made:
            number = self.made[key] = len(self.points)
            self.points.append(self.mesh.points[sorted(key)].mean(axis=0))
            self.shares += [(number, node, 1 / len(key)) for node in sorted(key)]
            self.corners[number] = key
        return self.made[key]

    def finished(self, children):
        """children: for every block the list of (element of the block, nodes)."""
        mesh, blocks, parents, sides = self.mesh, [], [], []
        for block, elements in zip(mesh.blocks, children):
            own = numpy.array([element for element, _ in elements])
            nodes = numpy.array([nodes for _, nodes in elements])
            blocks.append(Block(block.name, block.id, nodes, {name: values[own] for name, values in block.attributes.items()}))
            parents.append(mesh.first(block.name) + own)
            outer = SIDES[mesh.dimension, block.nodes.shape[1]]
            inner = SIDES[mesh.dimension, nodes.shape[1]]
            for element, row in elements:
                faces = [frozenset(int(block.nodes[element][corner]) for corner in side) for side in outer]
                numbers = [0] * 7
                for i, side in enumerate(inner, start=1):
                    uses = frozenset().union(*(self.corners[int(row[corner])] for corner in side))
                    numbers[i] = next((j for j, face in enumerate(faces, start=1) if uses <= face), 0)
                sides.append(numbers)
        here, there, weights = (numpy.array(column) for column in zip(*self.shares))
        told = Mesh(numpy.array(self.points), blocks, {}, {}, (here, there, weights), numpy.concatenate(parents), numpy.array(sides))
        used = numpy.unique(numpy.concatenate([block.nodes.ravel() for block in blocks]))
        for name, members in mesh.node_sets.items():
            inside = set(members.tolist())
            told.node_sets[name] = numpy.array([n for n in used if self.corners[int(n)] <= inside], int)
        told.side_sets = {name: _new_sides(members, told) for name, members in mesh.side_sets.items()}
        return told


def refined(mesh, block):
    """Every element of a block in 4 (plane) or 8 of half the size; all nodes stay."""
    chosen = next(b for b in mesh.blocks if b.name == block)
    others = [b.nodes.ravel() for b in mesh.blocks if b is not chosen]
    if others and numpy.isin(chosen.nodes, numpy.concatenate(others)).any():
        raise CannotTell(f"block {block} shares nodes with another one")
    grown, children = _Growing(mesh), []
    for b in mesh.blocks:
        if b.name != block:
            children.append([(i, row) for i, row in enumerate(b.nodes)])
            continue
        d = mesh.dimension
        if b.nodes.shape[1] != 2**d:
            raise CannotTell(f"block {block} is not of quadrilaterals or hexahedra")
        places = CORNERS[: 2**d]
        own = []
        for i, row in enumerate(b.nodes):
            grid = {}
            for place in itertools.product((0, 1, 2), repeat=d):
                corners = [node for node, corner in zip(row, places) if all(p == 1 or 2 * c == p for p, c in zip(place, corner))]
                grid[place] = grown.between(corners)
            for low in itertools.product((0, 1), repeat=d):
                own.append((i, [grid[tuple(l + c for l, c in zip(low, corner))] for corner in places]))
        children.append(own)
    return grown.finished(children)


def split(mesh):
    """Every quadrilateral in two triangles, along alternating diagonals; every hexahedron in 24 tetrahedra around its middle and the middles of
    its faces, which fit those of its neighbours.
    """
    grown, children = _Growing(mesh), []
    for b in mesh.blocks:
        own = []
        for i, row in enumerate(b.nodes):
            kind = mesh.dimension, len(row)
            if kind == (2, 4):
                own += [(i, [row[k] for k in part]) for part in (((0, 1, 2), (0, 2, 3)) if i % 2 else ((0, 1, 3), (1, 2, 3)))]
            elif kind == (3, 8):
                middle = grown.between(row)
                for side in SIDES[kind]:
                    face = grown.between(row[list(side)])
                    for k in range(4):
                        a, c = row[side[k]], row[side[(k + 1) % 4]]
                        own.append((i, [c, a, face, middle]))
            else:
                own.append((i, row))
        children.append(own)
    if all(len(own) == len(b.nodes) for own, b in zip(children, mesh.blocks)):
        raise CannotTell("no quadrilaterals or hexahedra")
    return grown.finished(children)


def extruded(mesh, thickness=1.0):
    """A plane mesh of quadrilaterals as one layer of hexahedra from z = 0; node sets `told_back` and `told_front`."""
    if mesh.dimension != 2 or any(block.nodes.shape[1] != 4 for block in mesh.blocks):
        raise CannotTell("only plane quadrilaterals have a slice of hexahedra")
    n = len(mesh.points)
    points = numpy.concatenate([numpy.column_stack([mesh.points, numpy.full(n, z)]) for z in (0.0, thickness)])
    blocks = [dataclasses.replace(b, nodes=numpy.concatenate([b.nodes, b.nodes + n], axis=1)) for b in mesh.blocks]
    sets = {name: numpy.concatenate([members, members + n]) for name, members in mesh.node_sets.items()}
    sets.update(told_back=numpy.arange(n), told_front=numpy.arange(n) + n)
    sides = numpy.tile([0, 1, 2, 3, 4, 0, 0], (mesh.count, 1))
    return Mesh(points, blocks, sets, mesh.side_sets, (numpy.arange(2 * n), numpy.arange(2 * n) % n, numpy.ones(2 * n)), numpy.arange(mesh.count), sides)
