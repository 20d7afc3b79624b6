#include "SplitMesh.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Lists.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace coplane
{
namespace
{
/// `nodesOf(item)` is a list; items of a node come in ascending order.
template <class NodesOf>
Lists<int> itemsAtNodes(int nodes, int items, const NodesOf& nodesOf)
{
  return {std::size_t(nodes), [&](const auto& visit)
          {
            for (int item = 0; item < items; ++item)
              for (const int node : nodesOf(item))
                visit(std::size_t(node), item);
          }};
}

std::vector<int> nodesOf(const MeshFace& face)
{
  std::vector<int> nodes;
  for (const int node : face.nodes)
    if (node >= 0)
      nodes.push_back(node);
  return nodes;
}

/// Splits one mesh; the steps in order.
class Splitter
{
public:
  Splitter(const Mesh& mesh, const std::vector<MeshFace>& faces, const std::vector<Cut>& cuts,
           Hinges hinges)
      : before_(mesh), faces_(faces), hinges_(hinges), places_(placesOfElements(mesh)),
        cutOfFace_(faces.size(), -1)
  {
    for (int cut = int(cuts.size()) - 1; cut >= 0; --cut)
      for (const int face : cuts[cut].faces)
        cutOfFace_[face] = cut;
    result_.mesh = mesh;
  }

  SplitMesh split(const std::vector<Cut>& cuts)
  {
    const Lists<int> facesAt = itemsAtNodes(before_.nodes(), int(faces_.size()),
                                            [&](int face) { return nodesOf(faces_[face]); });
    const Lists<int> elementsAt = itemsAtNodes(before_.nodes(), int(places_.size()),
                                               [&](int e) { return nodesOfElement(e); });
    GlobalId nextId = *std::max_element(before_.nodeIds.begin(), before_.nodeIds.end());
    for (int node = 0; node < before_.nodes(); ++node)
    {
      const std::vector<std::vector<int>> groups = groupsAround(node, facesAt, elementsAt);
      if (groups.size() < 2)
        continue;
      if (!isCut(node, facesAt))
        result_.hinges.push_back(before_.coordinates[node]);
      std::vector<int> copies{node};
      for (std::size_t g = 1; g < groups.size(); ++g)
      {
        copies.push_back(result_.mesh.nodes());
        result_.mesh.nodeIds.push_back(++nextId);
        result_.mesh.coordinates.push_back(before_.coordinates[node]);
        for (const int element : groups[g])
          replace(element, node, copies[g]);
      }
      shareNodeSets(node, groups, copies, facesAt);
    }
    result_.copies = result_.mesh.nodes() - before_.nodes();
    addSideSets(cuts);
    numberBodies();
    return std::move(result_);
  }

private:
  std::vector<int> nodesOfElement(int element) const
  {
    const Mesh::Block& block = before_.blocks[places_[element].block];
    const int perElement = topology(block.type).nodes;
    const auto first = block.connectivity.begin() + places_[element].index * perElement;
    return {first, first + perElement};
  }

  bool isCut(int node, const Lists<int>& facesAt) const
  {
    for (const int face : facesAt[node])
      if (cutOfFace_[face] >= 0)
        return true;
    return false;
  }

  /// The elements around a node, in groups that hang together there; none when no cut meets the
  /// node and hinges stay.
  std::vector<std::vector<int>> groupsAround(int node, const Lists<int>& facesAt,
                                             const Lists<int>& elementsAt) const
  {
    if (hinges_ == Hinges::Stay && !isCut(node, facesAt))
      return {};
    std::map<int, int> parent;
    for (const int element : elementsAt[node])
      parent[element] = element;
    const auto rootOf = [&](int element)
    {
      while (parent[element] != element)
        element = parent[element];
      return element;
    };
    for (const int f : facesAt[node])
    {
      const MeshFace& face = faces_[f];
      if (face.count < 2 || cutOfFace_[f] >= 0)
        continue;
      const int a = rootOf(face.elements[0]), b = rootOf(face.elements[1]);
      parent[std::max(a, b)] = std::min(a, b); // roots are first elements
    }
    std::map<int, std::vector<int>> groupOfRoot;
    for (const auto& entry : parent)
      groupOfRoot[rootOf(entry.first)].push_back(entry.first);
    std::vector<std::vector<int>> groups;
    for (auto& entry : groupOfRoot)
      groups.push_back(std::move(entry.second));
    return groups;
  }

  void replace(int element, int node, int copy)
  {
    Mesh::Block& block = result_.mesh.blocks[places_[element].block];
    const int perElement = topology(block.type).nodes;
    const auto first = block.connectivity.begin() + places_[element].index * perElement;
    std::replace(first, first + perElement, node, copy);
  }

  void shareNodeSets(int node, const std::vector<std::vector<int>>& groups,
                     const std::vector<int>& copies, const Lists<int>& facesAt)
  {
    std::set<int> onJoint;
    for (const int face : facesAt[node])
      if (cutOfFace_[face] >= 0)
        for (const int other : nodesOf(faces_[face]))
          onJoint.insert(other);
    if (members_.empty())
      for (const Mesh::NodeSet& set : before_.nodeSets)
        members_.emplace_back(set.nodes.begin(), set.nodes.end());
    for (std::size_t s = 0; s < members_.size(); ++s)
    {
      const std::set<int>& members = members_[s];
      if (!members.count(node))
        continue;
      std::vector<bool> belongs(groups.size(), false);
      for (std::size_t g = 0; g < groups.size(); ++g)
        for (const int element : groups[g])
          for (const int other : nodesOfElement(element))
            if (!onJoint.count(other) && members.count(other))
              belongs[g] = true;
      if (std::count(belongs.begin(), belongs.end(), true) == 0)
        belongs.assign(groups.size(), true);
      std::vector<int>& nodes = result_.mesh.nodeSets[s].nodes;
      if (!belongs[0])
        nodes.erase(std::find(nodes.begin(), nodes.end(), node));
      for (std::size_t g = 1; g < groups.size(); ++g)
        if (belongs[g])
          nodes.push_back(copies[g]);
    }
  }

  std::vector<int> nodesOfSide(int element, int side) const
  {
    const Mesh::Block& block = result_.mesh.blocks[places_[element].block];
    const ElementTopology& shape = topology(block.type);
    std::vector<int> nodes;
    for (int k = 0; k < shape.nodesPerSide; ++k)
      nodes.push_back(
          block.connectivity[places_[element].index * shape.nodes + shape.sideNodes[side][k]]);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  void addSideSets(const std::vector<Cut>& cuts)
  {
    GlobalId id = 0;
    for (const Mesh::SideSet& set : before_.sideSets)
      id = std::max(id, set.id);
    for (std::size_t c = 0; c < cuts.size(); ++c)
    {
      CutReport report{cuts[c].name};
      Mesh::SideSet set{++id, cuts[c].name, {}, {}};
      for (std::size_t f = 0; f < faces_.size(); ++f)
      {
        const MeshFace& face = faces_[f];
        if (cutOfFace_[f] != int(c))
          continue;
        if (nodesOfSide(face.elements[0], face.sides[0]) ==
            nodesOfSide(face.elements[1], face.sides[1]))
        {
          ++report.closed;
          if (const Real area = areaOf(before_, face); area > report.largestClosed)
          {
            report.largestClosed = area;
            report.closedPlace = centreOf(before_, face);
          }
          continue;
        }
        ++report.opened;
        report.area += areaOf(before_, face);
        for (int k = 0; k < 2; ++k)
        {
          set.elements.push_back(face.elements[k]);
          set.sides.push_back(face.sides[k]);
        }
      }
      result_.cuts.push_back(report);
      result_.mesh.sideSets.push_back(std::move(set));
    }
  }

  void numberBodies()
  {
    const auto largest = [](const std::vector<int>& numbers)
    { return *std::max_element(numbers.begin(), numbers.end()); };
    result_.bodiesBefore = largest(bodiesOfElements(before_));
    const std::vector<int> bodies = bodiesOfElements(result_.mesh);
    result_.bodies = largest(bodies);
    std::size_t element = 0;
    for (Mesh::Block& block : result_.mesh.blocks)
    {
      block.bodyIds.resize(block.elements());
      for (int& body : block.bodyIds)
        body = bodies[element++];
    }
  }

  const Mesh& before_;
  const std::vector<MeshFace>& faces_;
  Hinges hinges_;
  std::vector<ElementPlace> places_;
  std::vector<int> cutOfFace_;         ///< -1 where no cut is
  std::vector<std::set<int>> members_; ///< of the node sets
  SplitMesh result_;
};
} // namespace

SplitMesh splitMesh(const Mesh& mesh, const std::vector<MeshFace>& faces,
                    const std::vector<Cut>& cuts, Hinges hinges)
{
  for (const Cut& cut : cuts)
    for (const int face : cut.faces)
      if (faces[face].count != 2)
        fail(ExitCode::Internal, "the cut '{}' has a face of one element", cut.name);
  return Splitter(mesh, faces, cuts, hinges).split(cuts);
}
} // namespace coplane
