#include "MergeMeshes.hpp"

#include "MeshFaces.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/PlaceText.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace coplane
{
namespace
{
/// Places in cells of a grid, so that those near a point are found.
class NearPlaces
{
public:
  explicit NearPlaces(Real reach) : reach_(reach) {}

  void add(const Vec3& x, int node) { nodes_[cellOf(x)].push_back({x, node}); }

  /// Nodes that are no farther than the reach, the nearest first.
  std::vector<int> near(const Vec3& x) const
  {
    std::vector<std::pair<Real, int>> found;
    const Cell cell = cellOf(x);
    for (int k = 0; k < 27; ++k)
    {
      const auto place =
          nodes_.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (place == nodes_.end())
        continue;
      for (const auto& [other, node] : place->second)
        if (const Real away = norm(other - x); away <= reach_)
          found.push_back({away, node});
    }
    std::sort(found.begin(), found.end());
    std::vector<int> nodes;
    for (const auto& [away, node] : found)
      nodes.push_back(node);
    return nodes;
  }

private:
  using Cell = std::array<Real, 3>; ///< whole numbers, also where they are beyond those of integers

  Cell cellOf(const Vec3& x) const
  {
    return {std::floor(x.x / reach_), std::floor(x.y / reach_), std::floor(x.z / reach_)};
  }

  Real reach_;
  std::map<Cell, std::vector<std::pair<Vec3, int>>> nodes_;
};

/// Puts meshes together, one after another.
class Merger
{
public:
  Merger(const std::vector<MeshToMerge>& meshes, Real weld) : meshes_(meshes), weld_(weld) {}

  MergedMesh merge()
  {
    Mesh& mesh = result_.mesh;
    mesh.title = meshes_.front().mesh.title;
    mesh.dimension = meshes_.front().mesh.dimension;
    for (const MeshToMerge& added : meshes_)
    {
      if (added.mesh.dimension != mesh.dimension)
        fail(ExitCode::Mesh,
             "{} has {} dimensions and {} has {}; meshes of one dimension go "
             "together.",
             meshes_.front().source, mesh.dimension, added.source, added.mesh.dimension);
      addNodes(added);
      addBlocks(added);
      addNodeSets(added);
      addSideSets(added);
      mesh.qaRecords.insert(mesh.qaRecords.end(), added.mesh.qaRecords.begin(),
                            added.mesh.qaRecords.end());
    }
    if (weld_ > 0 && std::count(result_.welded.begin(), result_.welded.end(), 0) ==
                         std::ptrdiff_t(result_.welded.size()))
      fail(ExitCode::Mesh,
           "no nodes of {} and of the meshes after it are within {:.6g} m of each other: nothing "
           "would be welded. Compare the bounding boxes that coplane_mesh check prints, or take a "
           "larger tolerance; without --weld bodies that touch are in contact.",
           meshes_.front().source, weld_);
    number();
    if (weld_ > 0)
      noteFacesInside();
    return std::move(result_);
  }

private:
  std::string nameOf(const MeshToMerge& added, const std::string& own) const
  {
    return added.prefix + own;
  }

  Real resolution() const { return weld_ > 0 ? weld_ / 10 : 1e-3; }

  /// The nodes, those near a node of the meshes before as that one.
  void addNodes(const MeshToMerge& added)
  {
    Mesh& mesh = result_.mesh;
    const int before = mesh.nodes();
    nodeOf_.assign(added.mesh.nodeIds.size(), -1);
    result_.welded.push_back(0);
    if (weld_ > 0)
      weldNodes(added);
    for (std::size_t node = 0; node < nodeOf_.size(); ++node)
      if (nodeOf_[node] < 0)
      {
        nodeOf_[node] = mesh.nodes();
        mesh.nodeIds.push_back(GlobalId(mesh.nodeIds.size()) + 1);
        mesh.coordinates.push_back(added.mesh.coordinates[node]);
        origins_.push_back({int(result_.welded.size()) - 1, added.mesh.nodeIds[node]});
      }
    for (std::size_t node = std::size_t(before); weld_ > 0 && node < mesh.coordinates.size();
         ++node)
      places_.add(mesh.coordinates[node], int(node));
  }

  std::string textOf(int node) const
  {
    const auto& [mesh, id] = origins_[std::size_t(node)];
    return fmt::format("node {} of {}", id, meshes_[std::size_t(mesh)].source);
  }

  void weldNodes(const MeshToMerge& added)
  {
    std::map<int, std::size_t> taken; // nodes before, and the node that has become one with each
    for (std::size_t node = 0; node < nodeOf_.size(); ++node)
    {
      const std::vector<int> near = places_.near(added.mesh.coordinates[node]);
      if (near.empty())
        continue;
      const auto own = fmt::format("node {} of {}", added.mesh.nodeIds[node], added.source);
      const auto refuse =
          [&](const std::string& one, const std::string& other, const std::string& middle)
      {
        fail(ExitCode::Mesh,
             "{} and {} are both within {:.6g} m of {} at {} m, which can be welded to one of "
             "them: a joint ends there, or the tolerance reaches beyond an element. Take a smaller "
             "tolerance, or weld the meshes before their joints are opened.",
             one, other, weld_, middle, placeText(added.mesh.coordinates[node], resolution()));
      };
      if (near.size() > 1)
        refuse(textOf(near[0]), textOf(near[1]), own);
      if (const auto [place, isNew] = taken.insert({near[0], node}); !isNew)
        refuse(fmt::format("node {} of {}", added.mesh.nodeIds[place->second], added.source), own,
               textOf(near[0]));
      nodeOf_[node] = near[0];
      welded_.insert(near[0]);
      ++result_.welded.back();
    }
  }

  /// The block or set of a name; what has come with another mesh may only be joined.
  template <class Group>
  Group& groupOf(std::vector<Group>& groups, std::map<std::string, std::string>& sources,
                 const MeshToMerge& added, const std::string& name, const char* what)
  {
    const auto [source, isNew] = sources.insert({name, added.source});
    if (isNew)
    {
      groups.emplace_back();
      groups.back().id = GlobalId(groups.size());
      groups.back().name = name;
      return groups.back();
    }
    if (!added.join)
      fail(ExitCode::Mesh,
           "{} and {} both have a {} '{}'. Accepted: names that differ. Put something before the "
           "names of each mesh (--prefix wall_ --prefix bar_; in a recipe meshes.<index>.prefix), "
           "or let {}s of one name become one (--join; meshes.<index>.join).",
           source->second, added.source, what, name, what);
    return *std::find_if(groups.begin(), groups.end(),
                         [&](const Group& group) { return group.name == name; });
  }

  void addBlocks(const MeshToMerge& added)
  {
    elementPlaces_.clear();
    for (const Mesh::Block& own : added.mesh.blocks)
    {
      const std::string name = nameOf(added, own.name);
      const bool isThere = blocks_.count(name) > 0;
      Mesh::Block& block = groupOf(result_.mesh.blocks, blocks_, added, name, "block");
      if (!isThere)
        block.type = own.type;
      else if (block.type != own.type)
        fail(ExitCode::Mesh,
             "the block '{}' has {} elements in {} and {} in {}; a block has elements of one type. "
             "Name it otherwise in one of them (--prefix; in a recipe meshes.<index>.prefix).",
             name, topology(block.type).exodusName, blocks_.at(name), topology(own.type).exodusName,
             added.source);
      const int position = int(&block - result_.mesh.blocks.data());
      const int perElement = topology(own.type).nodes;
      for (int e = 0; e < own.elements(); ++e)
      {
        elementPlaces_.push_back({position, block.elements()});
        block.elementIds.push_back(0); // all are numbered at the end
        const auto first = own.connectivity.begin() + std::ptrdiff_t(e) * perElement;
        const std::size_t begin = block.connectivity.size();
        for (auto node = first; node != first + perElement; ++node)
          block.connectivity.push_back(nodeOf_[std::size_t(*node)]);
        demandDistinct(block, begin, own.elementIds[std::size_t(e)], added);
      }
    }
  }

  /// Welding must not pull an element together; what was so before is for the report to tell.
  void demandDistinct(const Mesh::Block& block, std::size_t begin, GlobalId element,
                      const MeshToMerge& added) const
  {
    if (result_.welded.back() == 0)
      return;
    std::vector<int> nodes(block.connectivity.begin() + std::ptrdiff_t(begin),
                           block.connectivity.end());
    std::sort(nodes.begin(), nodes.end());
    if (const auto twice = std::adjacent_find(nodes.begin(), nodes.end()); twice != nodes.end())
      fail(ExitCode::Mesh,
           "element {} of {} would have {} twice, at {} m: the tolerance {:.6g} m reaches beyond "
           "an edge of it. Take a smaller one.",
           element, added.source, textOf(*twice),
           placeText(result_.mesh.coordinates[std::size_t(*twice)], resolution()), weld_);
  }

  void addNodeSets(const MeshToMerge& added)
  {
    for (const Mesh::NodeSet& own : added.mesh.nodeSets)
    {
      Mesh::NodeSet& set =
          groupOf(result_.mesh.nodeSets, nodeSets_, added, nameOf(added, own.name), "node set");
      for (const int node : own.nodes)
        set.nodes.push_back(nodeOf_[std::size_t(node)]);
      std::sort(set.nodes.begin(), set.nodes.end());
      set.nodes.erase(std::unique(set.nodes.begin(), set.nodes.end()), set.nodes.end());
    }
  }

  /// Blocks may still grow, so elements are kept by their places until all are there.
  void addSideSets(const MeshToMerge& added)
  {
    for (const Mesh::SideSet& own : added.mesh.sideSets)
    {
      Mesh::SideSet& set =
          groupOf(result_.mesh.sideSets, sideSets_, added, nameOf(added, own.name), "side set");
      set.sides.insert(set.sides.end(), own.sides.begin(), own.sides.end());
      std::vector<ElementPlace>& places = elementsOfSideSet_[set.name];
      for (const int element : own.elements)
        places.push_back(elementPlaces_[std::size_t(element)]);
    }
  }

  void number()
  {
    Mesh& mesh = result_.mesh;
    std::vector<int> firstOfBlock;
    int count = 0;
    for (Mesh::Block& block : mesh.blocks)
    {
      firstOfBlock.push_back(count);
      for (GlobalId& id : block.elementIds)
        id = ++count;
    }
    for (Mesh::SideSet& set : mesh.sideSets)
      for (const ElementPlace& place : elementsOfSideSet_[set.name])
        set.elements.push_back(firstOfBlock[std::size_t(place.block)] + place.index);
    const std::vector<int> bodies = bodiesOfElements(mesh);
    auto body = bodies.begin();
    for (Mesh::Block& block : mesh.blocks)
    {
      block.bodyIds.assign(body, body + block.elements());
      body += block.elements();
    }
  }

  /// Sides of which welding has made faces between two elements; and nodes that join nothing but
  /// themselves, since the meshes do not match there: bodies that hang together like that are
  /// hinges.
  void noteFacesInside()
  {
    std::map<std::pair<int, int>, std::array<int, 2>> inside;
    std::set<int> hinges = welded_;
    const auto isWelded = [&](int node) { return node < 0 || welded_.count(node) > 0; };
    for (const MeshFace& face : facesOf(result_.mesh))
      if (face.count == 2)
      {
        for (int k = 0; k < 2; ++k)
          inside[{face.elements[std::size_t(k)], face.sides[std::size_t(k)]}] = face.elements;
        if (std::all_of(face.nodes.begin(), face.nodes.end(), isWelded))
          for (const int node : face.nodes)
            hinges.erase(node);
      }
    if (!hinges.empty())
      result_.notes.push_back(fmt::format(
          "{} of {} welded nodes lie on no face that two elements share, the first at {} m: the "
          "meshes do not match there and hang together by nodes only. Mesh both sides alike, or "
          "leave --weld out and let a joint hold them",
          hinges.size(), welded_.size(),
          placeText(result_.mesh.coordinates[std::size_t(*hinges.begin())], resolution())));
    for (const Mesh::SideSet& set : result_.mesh.sideSets)
    {
      std::size_t count = 0;
      for (std::size_t s = 0; s < set.elements.size(); ++s)
        count += inside.count({set.elements[s], set.sides[s]});
      if (count > 0)
        result_.notes.push_back(
            fmt::format("side set '{}': {} of its {} faces lie between two elements of one body",
                        set.name, count, set.elements.size()));
    }
  }

  const std::vector<MeshToMerge>& meshes_;
  Real weld_;
  NearPlaces places_{weld_ > 0 ? weld_ : 1};
  std::vector<std::pair<int, GlobalId>> origins_; ///< by node: the mesh it has come with, its id
  std::map<std::string, std::string> blocks_, nodeSets_, sideSets_; ///< names, and from where
  std::map<std::string, std::vector<ElementPlace>> elementsOfSideSet_;
  std::set<int> welded_;
  std::vector<int> nodeOf_;                 ///< of the mesh that is being added
  std::vector<ElementPlace> elementPlaces_; ///< of its elements
  MergedMesh result_;
};
} // namespace

MergedMesh mergeMeshes(const std::vector<MeshToMerge>& meshes, Real weld)
{
  return Merger(meshes, weld).merge();
}
} // namespace coplane
