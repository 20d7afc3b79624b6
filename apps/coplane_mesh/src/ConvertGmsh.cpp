#include "ConvertGmsh.hpp"

#include "MeshFaces.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshReport.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace coplane
{
namespace
{
ElementType elementTypeOf(int gmshType)
{
  switch (gmshType)
  {
  case 2:
    return ElementType::Tri3;
  case 3:
    return ElementType::Quad4;
  case 4:
    return ElementType::Tet4;
  default:
    return ElementType::Hex8;
  }
}

std::string lowerCase(std::string text)
{
  for (char& c : text)
    c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

class Converter
{
public:
  Converter(const GmshFile& file, const std::string& name) : file_(file), name_(name) {}

  ConvertedMesh convert()
  {
    Mesh& mesh = result_.mesh;
    mesh.dimension = highestDimension();
    if (mesh.dimension < 2)
      fail(ExitCode::Mesh,
           "{}: the file has no elements of a surface or a volume. Mesh the model in two or three "
           "dimensions, and put what shall be saved into physical groups.",
           name_);
    for (const GmshFile::Element& element : file_.elements)
      hasGroups_ = hasGroups_ ||
                   (element.entity.first == mesh.dimension && !groupsOf(element.entity).empty());
    for (const auto& [group, name] : file_.physicalNames)
      if (group.first == mesh.dimension)
        hasGroups_ = true;
    addBlocks();
    if (mesh.dimension == 2)
      checkPlane();
    turnElements();
    addSets();
    return std::move(result_);
  }

private:
  int highestDimension() const
  {
    int highest = 0;
    for (const GmshFile::Element& element : file_.elements)
      highest = std::max(highest, element.entity.first);
    return highest;
  }

  std::vector<int> groupsOf(const GmshFile::Tag& entity) const
  {
    const auto found = file_.physicalsOfEntity.find(entity);
    return found == file_.physicalsOfEntity.end() ? std::vector<int>{} : found->second;
  }

  std::string nameOf(const GmshFile::Tag& group, const char* kind) const
  {
    const auto found = file_.physicalNames.find(group);
    return found == file_.physicalNames.end() || found->second.empty()
               ? fmt::format("{}_{}", kind, group.second)
               : found->second;
  }

  /// The name of the block of an element; empty when it is in no group and groups exist.
  std::string blockOf(const GmshFile::Element& element) const
  {
    const std::vector<int> groups = groupsOf(element.entity);
    if (groups.size() > 1)
      fail(ExitCode::Mesh,
           "{}: {} {} is in the physical groups '{}' and '{}'; an element belongs to one block. "
           "Take "
           "it out of one of them.",
           name_, element.entity.first == 2 ? "surface" : "volume", element.entity.second,
           nameOf({element.entity.first, groups[0]}, "block"),
           nameOf({element.entity.first, groups[1]}, "block"));
    if (!groups.empty())
      return nameOf({element.entity.first, groups[0]}, "block");
    return hasGroups_ ? std::string() : fmt::format("block_{}", element.entity.second);
  }

  void addBlocks()
  {
    Mesh& mesh = result_.mesh;
    // In the order of the file; a group with both shapes of its dimension becomes two blocks.
    std::vector<std::pair<std::string, int>> keys;
    int dropped = 0;
    for (const GmshFile::Element& element : file_.elements)
    {
      if (element.entity.first != mesh.dimension)
        continue;
      const std::pair<std::string, int> key{blockOf(element), element.type};
      if (key.first.empty())
        ++dropped;
      else if (std::find(keys.begin(), keys.end(), key) == keys.end())
        keys.push_back(key);
    }
    if (dropped > 0)
      note(fmt::format("{} elements are in no physical group and are left out", dropped));
    if (keys.empty())
      fail(ExitCode::Mesh,
           "{}: no element of the mesh is in a physical group of its dimension. Put the {} into "
           "one.",
           name_, mesh.dimension == 2 ? "surfaces" : "volumes");
    for (const auto& [name, type] : keys)
    {
      const auto sameName = [&, &name = name](const auto& key) { return key.first == name; };
      const ElementType shape = elementTypeOf(type);
      Mesh::Block block{GlobalId(mesh.blocks.size()) + 1, name, shape, {}, {}, {}};
      if (std::count_if(keys.begin(), keys.end(), sameName) > 1)
        block.name += "_" + lowerCase(topology(shape).exodusName);
      mesh.blocks.push_back(std::move(block));
    }
    std::vector<int> used(file_.nodeIds.size(), 0);
    for (const GmshFile::Element& element : file_.elements)
    {
      if (element.entity.first != mesh.dimension)
        continue;
      const auto key = std::find(keys.begin(), keys.end(),
                                 std::pair<std::string, int>{blockOf(element), element.type});
      if (key == keys.end())
        continue;
      Mesh::Block& block = mesh.blocks[key - keys.begin()];
      block.elementIds.push_back(element.id);
      for (int k = 0; k < nodesOfGmshType(element.type); ++k)
      {
        used[element.nodes[k]] = 1;
        block.connectivity.push_back(element.nodes[k]);
      }
    }
    keepNodes(used);
  }

  void keepNodes(const std::vector<int>& used)
  {
    Mesh& mesh = result_.mesh;
    newOfNode_.assign(used.size(), -1);
    for (std::size_t node = 0; node < used.size(); ++node)
      if (used[node])
      {
        newOfNode_[node] = mesh.nodes();
        mesh.nodeIds.push_back(file_.nodeIds[node]);
        mesh.coordinates.push_back(file_.coordinates[node]);
      }
    if (const auto left = used.size() - mesh.nodeIds.size(); left > 0)
      note(fmt::format("{} nodes belong to no element and are left out", left));
    for (Mesh::Block& block : mesh.blocks)
      for (int& node : block.connectivity)
        node = newOfNode_[node];
    const std::vector<int> bodies = bodiesOfElements(mesh);
    std::size_t element = 0;
    for (Mesh::Block& block : mesh.blocks)
      for (int e = 0; e < block.elements(); ++e)
        block.bodyIds.push_back(bodies[element++]);
  }

  void checkPlane()
  {
    const Real tolerance = 1e-9 * sizeOf(result_.mesh);
    for (int node = 0; node < result_.mesh.nodes(); ++node)
    {
      Vec3& x = result_.mesh.coordinates[node];
      if (!(std::abs(x.z) <= tolerance))
        fail(ExitCode::Mesh,
             "{}: the mesh has no volume elements, and node {} is at z = {} m; a mesh of two "
             "dimensions lies in z = 0. Move or turn the model, or add the volumes to a physical "
             "group and mesh in three dimensions.",
             name_, result_.mesh.nodeIds[node], x.z);
      x.z = 0;
    }
  }

  /// Elements of negative volume get the order of nodes that makes it positive.
  void turnElements()
  {
    static const std::map<ElementType, std::vector<int>> mirrored{
        {ElementType::Tri3, {0, 2, 1}},
        {ElementType::Quad4, {0, 3, 2, 1}},
        {ElementType::Tet4, {0, 2, 1, 3}},
        {ElementType::Hex8, {4, 5, 6, 7, 0, 1, 2, 3}}};
    int turned = 0;
    for (Mesh::Block& block : result_.mesh.blocks)
    {
      const std::vector<int>& order = mirrored.at(block.type);
      for (int e = 0; e < block.elements(); ++e)
      {
        int* nodes = &block.connectivity[e * order.size()];
        std::array<Vec3, 8> corners{};
        for (std::size_t k = 0; k < order.size(); ++k)
          corners[k] = result_.mesh.coordinates[nodes[k]];
        if (!(elementVolume(block.type, corners) < 0))
          continue;
        const std::vector<int> before(nodes, nodes + order.size());
        for (std::size_t k = 0; k < order.size(); ++k)
          nodes[k] = before[order[k]];
        ++turned;
      }
    }
    if (turned > 0)
      note(fmt::format("{} elements were inside out and have been turned", turned));
  }

  /// Groups below the dimension of the mesh, by dimension from the highest, then by number.
  void addSets()
  {
    Mesh& mesh = result_.mesh;
    std::map<std::pair<int, int>, std::vector<const GmshFile::Element*>> groups;
    for (const GmshFile::Element& element : file_.elements)
      if (element.entity.first < mesh.dimension)
        for (const int group : groupsOf(element.entity))
          groups[{-element.entity.first, group}].push_back(&element);
    if (groups.empty())
      return;
    std::map<std::array<int, 4>, const MeshFace*> faceOfNodes;
    const std::vector<MeshFace> faces = facesOf(mesh);
    for (const MeshFace& face : faces)
      faceOfNodes[sorted(face.nodes)] = &face;
    for (const auto& [key, elements] : groups)
    {
      const GmshFile::Tag group{-key.first, key.second};
      if (group.first == mesh.dimension - 1)
        addSideSet(nameOf(group, "surface"), elements, faceOfNodes);
      addNodeSet(nameOf(group, "nodelist"), elements);
    }
  }

  static std::array<int, 4> sorted(std::array<int, 4> nodes)
  {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  /// The set of a name; groups of one name share it.
  template <class Set>
  static Set& setOf(std::vector<Set>& sets, const std::string& name)
  {
    for (Set& set : sets)
      if (set.name == name)
        return set;
    Set& set = sets.emplace_back();
    set.id = GlobalId(sets.size());
    set.name = name;
    return set;
  }

  /// Faces on the surface, and both sides of those inside.
  void addSideSet(const std::string& name, const std::vector<const GmshFile::Element*>& elements,
                  const std::map<std::array<int, 4>, const MeshFace*>& faceOfNodes)
  {
    std::set<std::pair<int, int>> sides;
    int strangers = 0;
    for (const GmshFile::Element* element : elements)
    {
      std::array<int, 4> nodes{-1, -1, -1, -1};
      for (int k = 0; k < nodesOfGmshType(element->type); ++k)
        nodes[k] = newOfNode_[element->nodes[k]];
      const auto face = faceOfNodes.find(sorted(nodes));
      if (face == faceOfNodes.end())
        ++strangers;
      else
        for (int k = 0; k < face->second->count; ++k)
          sides.insert({face->second->elements[k], face->second->sides[k]});
    }
    if (strangers > 0)
      note(
          fmt::format("group '{}': {} of its {} elements are no side of an element of the mesh and "
                      "are left out",
                      name, strangers, elements.size()));
    if (sides.empty())
      return;
    Mesh::SideSet& set = setOf(result_.mesh.sideSets, name);
    for (std::size_t i = 0; i < set.elements.size(); ++i)
      sides.insert({set.elements[i], set.sides[i]});
    set.elements.clear();
    set.sides.clear();
    for (const auto& [element, side] : sides)
    {
      set.elements.push_back(element);
      set.sides.push_back(side);
    }
  }

  void addNodeSet(const std::string& name, const std::vector<const GmshFile::Element*>& elements)
  {
    std::set<int> nodes;
    for (const GmshFile::Element* element : elements)
      for (int k = 0; k < nodesOfGmshType(element->type); ++k)
        if (const int node = newOfNode_[element->nodes[k]]; node >= 0)
          nodes.insert(node);
    if (nodes.empty())
    {
      note(fmt::format("group '{}': its nodes belong to no element, and it is left out", name));
      return;
    }
    Mesh::NodeSet& set = setOf(result_.mesh.nodeSets, name);
    nodes.insert(set.nodes.begin(), set.nodes.end());
    set.nodes.assign(nodes.begin(), nodes.end());
  }

  void note(const std::string& text) { result_.notes.push_back(text); }

  const GmshFile& file_;
  const std::string& name_;
  bool hasGroups_ = false;     ///< some element of the mesh's dimension is in a physical group
  std::vector<int> newOfNode_; ///< -1 for nodes that are left out
  ConvertedMesh result_;
};
} // namespace

ConvertedMesh convertGmsh(const GmshFile& file, const std::string& name)
{
  return Converter(file, name).convert();
}
} // namespace coplane
