#include <coplane_contact/FaceContact.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/SideSetResults.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
/// Whether this rank owns the node with the lowest id of a side: then it alone brings the side's
/// values, and it holds all planes of its face.
bool isMine(const RankMesh& mesh, const RankMesh::Side& side)
{
  const RankMesh::Block& block = mesh.blocks[side.block];
  const ElementTopology& shape = topology(block.type);
  int lowest = -1;
  for (int k = 0; k < shape.nodesPerSide; ++k)
  {
    const int node = block.connectivity[side.element * shape.nodes + shape.sideNodes[side.side][k]];
    if (lowest < 0 || mesh.nodeIds[node] < mesh.nodeIds[lowest])
      lowest = node;
  }
  return lowest < mesh.ownedNodes;
}
} // namespace

std::vector<std::string> sideVariableNames()
{
  return {"side_state",
          "side_area_fraction",
          "side_normal_traction",
          "side_shear_traction",
          "side_closure",
          "side_gap",
          "side_slip"};
}

SideSetResults::SideSetResults(const Solver& solver, const ResultsFile& file)
{
  const RankMesh& mesh = solver.mesh();
  // Ids of the redistribution: the places of all sides in the file, set after set.
  std::vector<std::int64_t> sizes(mesh.sideSets.size(), 0);
  for (std::size_t s = 0; s < mesh.sideSets.size(); ++s)
    if (!file.mySides(int(s)).empty())
      sizes[s] = file.mySides(int(s)).back() + 1;
  std::vector<GlobalId> source, target;
  GlobalId first = 0;
  for (std::size_t s = 0; s < mesh.sideSets.size(); ++s)
  {
    for (const RankMesh::Side& side : mesh.sideSets[s])
      if (isMine(mesh, side))
      {
        source.push_back(first + side.position);
        faces_.push_back(faceId(mesh.blocks[side.block].elementIds[side.element], side.side));
      }
    for (const int position : file.mySides(int(s)))
      target.push_back(first + position);
    first += solver.comm().max(sizes[s]);
  }
  toFile_.emplace(solver.comm(), source, target);
}

void SideSetResults::write(const Solver& solver, ResultsFile& file) const
{
  const int columns = int(sideVariableNames().size());
  Table<Real> mine("coplane::output::sides", faces_.size(), columns);
  if (solver.hasContact())
  {
    const std::vector<Face>& faces = solver.contact().faces();
    const std::vector<FaceContact> seen = faceContact(solver.contact(), solver.state().x);
    for (std::size_t i = 0; i < faces_.size(); ++i)
    {
      // Local faces come first, sorted by id.
      const auto end = faces.begin() + std::ptrdiff_t(seen.size());
      const auto found = std::lower_bound(faces.begin(), end, faces_[i],
                                          [](const Face& f, GlobalId id) { return f.id < id; });
      if (found == end || found->id != faces_[i])
        continue;
      const FaceContact& face = seen[std::size_t(found - faces.begin())];
      const Real values[] = {Real(int(face.state)),
                             face.areaFraction,
                             face.normalTraction,
                             norm(face.shearTraction),
                             face.closure,
                             face.gap,
                             face.slip};
      for (int c = 0; c < columns; ++c)
        mine(i, c) = values[c];
    }
  }
  std::size_t rows = 0;
  for (int s = 0; s < file.sideSets(); ++s)
    rows += file.mySides(s).size();
  Table<Real> inFile("coplane::output::sidesInFile", rows, columns);
  toFile_->move(mine, inFile);
  std::size_t first = 0;
  for (int s = 0; s < file.sideSets(); ++s)
  {
    std::vector<Real> values(file.mySides(s).size());
    for (int c = 0; c < columns; ++c)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = inFile(first + i, c);
      file.putSide(c, s, values);
    }
    first += values.size();
  }
}
} // namespace coplane
