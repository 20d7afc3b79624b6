#include <coplane_core/Error.hpp>
#include <coplane_exodus/MeshParts.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <unordered_map>

namespace coplane
{
namespace
{
bool isNumber(const std::string& text)
{
  return !text.empty() && text.size() < 9 &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

/// Entities of all parts with one id, in the order of `order` where given.
template <class Entity, class Join>
std::vector<Entity> joined(const std::vector<Mesh>& parts, std::vector<Entity> Mesh::*entities,
                           std::vector<GlobalId> order, const Join& join)
{
  std::map<GlobalId, Entity> all;
  for (std::size_t p = 0; p < parts.size(); ++p)
    for (const Entity& entity : parts[p].*entities)
    {
      if (std::find(order.begin(), order.end(), entity.id) == order.end())
        order.push_back(entity.id);
      Entity empty;
      empty.id = entity.id;
      empty.name = entity.name;
      join(all.try_emplace(entity.id, empty).first->second, entity, p);
    }
  std::vector<Entity> result;
  for (const GlobalId id : order)
    if (const auto found = all.find(id); found != all.end())
      result.push_back(std::move(found->second));
  return result;
}

void sortElements(Mesh::Block& block)
{
  const int corners = topology(block.type).nodes;
  std::vector<int> order(block.elements());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return block.elementIds[a] < block.elementIds[b]; });
  Mesh::Block sorted = block;
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const int e = order[i];
    sorted.elementIds[i] = block.elementIds[e];
    sorted.bodyIds[i] = block.bodyIds[e];
    std::copy_n(&block.connectivity[e * corners], corners, &sorted.connectivity[i * corners]);
  }
  block = std::move(sorted);
}
} // namespace

std::vector<std::string> partsOfMesh(const std::string& file)
{
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(file).parent_path();
  const std::string start = fs::path(file).filename().string() + ".";
  std::map<int, std::map<int, std::string>> splits; // by number of parts: part -> name
  if (!fs::is_directory(folder))
    return {};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
  {
    const std::string name = entry.path().filename().string();
    if (name.compare(0, start.size(), start) != 0)
      continue;
    const std::size_t dot = name.find('.', start.size());
    if (dot == std::string::npos)
      continue;
    const std::string count = name.substr(start.size(), dot - start.size());
    const std::string number = name.substr(dot + 1);
    if (isNumber(count) && isNumber(number) && count.size() == number.size())
      splits[std::stoi(count)][std::stoi(number)] = (fs::path(file).parent_path() / name).string();
  }
  if (splits.empty())
    return {};
  if (splits.size() > 1)
    fail(ExitCode::Mesh,
         "{0}: the mesh does not exist, and its parts for {1} and for {2} ranks both do. Remove "
         "one of the two splits.",
         file, splits.begin()->first, splits.rbegin()->first);
  const auto& [count, names] = *splits.begin();
  std::vector<std::string> parts;
  for (int p = 0; p < count; ++p)
  {
    const auto found = names.find(p);
    if (found == names.end())
      fail(ExitCode::Mesh,
           "{}: part {} of the {} parts of this mesh is missing (they are named {}{}.0 and so on). "
           "Split the mesh again.",
           file, p, count, start, count);
    parts.push_back(found->second);
  }
  return parts;
}

Mesh mergedParts(const std::vector<Mesh>& parts, const std::vector<GlobalId>& blockOrder,
                 const std::string& file)
{
  Mesh mesh;
  mesh.title = parts[0].title;
  mesh.dimension = parts[0].dimension;
  mesh.qaRecords = parts[0].qaRecords;

  std::map<GlobalId, Vec3> positions;
  for (const Mesh& part : parts)
  {
    if (part.dimension != mesh.dimension)
      fail(ExitCode::Mesh, "{}: its parts have {} and {} dimensions; they are of two meshes.", file,
           mesh.dimension, part.dimension);
    for (int n = 0; n < part.nodes(); ++n)
    {
      const auto [place, isNew] = positions.emplace(part.nodeIds[n], part.coordinates[n]);
      const Vec3 apart = place->second - part.coordinates[n];
      if (!isNew && !(dot(apart, apart) == 0))
        fail(ExitCode::Mesh,
             "{}: node {} lies at different places in two of its parts; they are of two meshes. "
             "Split the mesh again.",
             file, part.nodeIds[n]);
    }
  }
  std::unordered_map<GlobalId, int> indexOfNode;
  for (const auto& [id, x] : positions)
  {
    indexOfNode[id] = mesh.nodes();
    mesh.nodeIds.push_back(id);
    mesh.coordinates.push_back(x);
  }
  const auto nodeIndex = [&](std::size_t part, int node)
  { return indexOfNode.at(parts[part].nodeIds[node]); };

  mesh.blocks = joined(
      parts, &Mesh::blocks, blockOrder,
      [&](Mesh::Block& all, const Mesh::Block& one, std::size_t p)
      {
        if (all.elementIds.empty())
          all.type = one.type;
        if (!one.elementIds.empty() && one.type != all.type)
          fail(ExitCode::Mesh,
               "{}: block {} has elements of two shapes in its parts; they are of "
               "two meshes.",
               file, one.id);
        all.elementIds.insert(all.elementIds.end(), one.elementIds.begin(), one.elementIds.end());
        all.bodyIds.insert(all.bodyIds.end(), one.bodyIds.begin(), one.bodyIds.end());
        for (const int node : one.connectivity)
          all.connectivity.push_back(nodeIndex(p, node));
      });
  std::unordered_map<GlobalId, int> indexOfElement;
  for (Mesh::Block& block : mesh.blocks)
  {
    sortElements(block);
    for (const GlobalId id : block.elementIds)
      if (!indexOfElement.emplace(id, int(indexOfElement.size())).second)
        fail(ExitCode::Mesh,
             "{}: element {} is in two of its parts; an element belongs to one. Split the mesh "
             "again.",
             file, id);
  }

  mesh.nodeSets =
      joined(parts, &Mesh::nodeSets, {},
             [&](Mesh::NodeSet& all, const Mesh::NodeSet& one, std::size_t p)
             {
               for (const int node : one.nodes)
                 all.nodes.push_back(nodeIndex(p, node));
               std::sort(all.nodes.begin(), all.nodes.end());
               all.nodes.erase(std::unique(all.nodes.begin(), all.nodes.end()), all.nodes.end());
             });
  std::vector<std::vector<GlobalId>> elementsOf; // ids of each part, in the order of its blocks
  for (const Mesh& part : parts)
  {
    elementsOf.emplace_back();
    for (const Mesh::Block& block : part.blocks)
      elementsOf.back().insert(elementsOf.back().end(), block.elementIds.begin(),
                               block.elementIds.end());
  }
  mesh.sideSets =
      joined(parts, &Mesh::sideSets, {},
             [&](Mesh::SideSet& all, const Mesh::SideSet& one, std::size_t p)
             {
               for (std::size_t i = 0; i < one.elements.size(); ++i)
               {
                 all.elements.push_back(indexOfElement.at(elementsOf[p].at(one.elements[i])));
                 all.sides.push_back(one.sides[i]);
               }
             });
  for (Mesh::SideSet& set : mesh.sideSets)
  {
    std::vector<std::pair<int, int>> sides;
    for (std::size_t i = 0; i < set.elements.size(); ++i)
      sides.emplace_back(set.elements[i], set.sides[i]);
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); ++i)
      std::tie(set.elements[i], set.sides[i]) = sides[i];
  }
  return mesh;
}
} // namespace coplane
