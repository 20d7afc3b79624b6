#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/detail/MeshDefinition.hpp>

#include <exodusII.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace coplane
{
namespace
{
template <std::size_t n>
void copyText(char (&target)[n], const std::string& text)
{
  const std::size_t length = std::min(text.size(), n - 1);
  std::memcpy(target, text.data(), length);
  target[length] = '\0';
}

template <class Entities>
void putNames(int exoid, ex_entity_type type, const Entities& entities)
{
  std::vector<std::string> list;
  for (const auto& entity : entities)
    list.push_back(entity.name);
  ExodusNames names(std::move(list));
  if (names.size() > 0)
    checkExodus(ex_put_names(exoid, type, names.data()), "names");
}

void allowLongNames(int exoid, const Mesh& mesh, const FileExtras& extras)
{
  std::size_t longest = 32;
  const auto consider = [&](const std::string& name) { longest = std::max(longest, name.size()); };
  for (const auto& block : mesh.blocks)
    consider(block.name);
  for (const auto& set : mesh.nodeSets)
    consider(set.name);
  for (const auto& set : mesh.sideSets)
    consider(set.name);
  for (const auto* names :
       {&extras.nodalNames, &extras.elementNames, &extras.globalNames, &extras.sideNames})
    for (const std::string& name : *names)
      consider(name);
  checkExodus(ex_set_max_name_length(exoid, int(std::min<std::size_t>(longest, 255))), "names");
}

void defineBlocks(int exoid, const MeshSlice& slice)
{
  const std::vector<Mesh::Block>& all = slice.mine.blocks;
  std::vector<ex_block> blocks;
  for (std::size_t k = 0; k < all.size(); ++k)
  {
    ex_block b{};
    b.id = all[k].id;
    b.type = EX_ELEM_BLOCK;
    copyText(b.topology, topology(all[k].type).exodusName);
    b.num_entry = slice.elementsOf(int(k));
    b.num_nodes_per_entry = topology(all[k].type).nodes;
    b.num_attribute = 1;
    blocks.push_back(b);
  }
  if (!blocks.empty())
    checkExodus(ex_put_block_params(exoid, blocks.size(), blocks.data()), "element blocks");
  for (std::size_t k = 0; k < all.size(); ++k)
    if (slice.elementsOf(int(k)) > 0)
    {
      ExodusNames names({"body_id"});
      checkExodus(ex_put_attr_names(exoid, EX_ELEM_BLOCK, all[k].id, names.data()),
                  "attribute names");
    }
}

void defineSets(int exoid, const MeshSlice& slice)
{
  std::vector<ex_set> sets;
  const auto add = [&](ex_entity_type type, GlobalId id, int entries)
  {
    ex_set s{};
    s.id = id;
    s.type = type;
    s.num_entry = entries;
    sets.push_back(s);
  };
  for (std::size_t s = 0; s < slice.mine.nodeSets.size(); ++s)
    add(EX_NODE_SET, slice.mine.nodeSets[s].id, slice.nodeSetSizes[s]);
  for (std::size_t s = 0; s < slice.mine.sideSets.size(); ++s)
    add(EX_SIDE_SET, slice.mine.sideSets[s].id, slice.sideSetSizes[s]);
  if (!sets.empty())
    checkExodus(ex_put_sets(exoid, sets.size(), sets.data()), "node and side sets");
}

/// This rank's ranges of the id maps. The first call for a map defines it.
void putIds(int exoid, const MeshSlice& slice)
{
  if (const IndexRange mine = slice.nodeRange(); mine.count > 0)
    checkExodus(ex_put_partial_id_map(exoid, EX_NODE_MAP, mine.first + 1, mine.count,
                                      slice.mine.nodeIds.data()),
                "node ids");
  for (std::size_t b = 0; b < slice.mine.blocks.size(); ++b)
    if (const IndexRange mine = slice.elementRange(int(b)); mine.count > 0)
      checkExodus(ex_put_partial_id_map(exoid, EX_ELEM_MAP, slice.firstElements[b] + mine.first + 1,
                                        mine.count, slice.mine.blocks[b].elementIds.data()),
                  "element ids");
}

void putRecords(int exoid, const Mesh& mesh, const FileExtras& extras)
{
  if (!mesh.qaRecords.empty())
  {
    std::vector<std::array<std::string, 4>> records = mesh.qaRecords;
    using Record = char* [4];
    const auto pointers = std::make_unique<Record[]>(records.size());
    for (std::size_t i = 0; i < records.size(); ++i)
      for (int k = 0; k < 4; ++k)
      {
        records[i][k].resize(std::min<std::size_t>(records[i][k].size(), MAX_STR_LENGTH));
        pointers[i][k] = records[i][k].data();
      }
    checkExodus(ex_put_qa(exoid, int(records.size()), pointers.get()), "QA records");
  }
  if (!extras.infoLines.empty())
  {
    ExodusNames lines(extras.infoLines);
    checkExodus(ex_put_info(exoid, lines.size(), lines.data()), "info records");
  }
}

void defineVariables(int exoid, const MeshSlice& slice, const FileExtras& extras)
{
  std::vector<int> truth, sideTruth;
  for (std::size_t b = 0; b < slice.mine.blocks.size(); ++b)
    truth.insert(truth.end(), extras.elementNames.size(), slice.elementsOf(int(b)) > 0 ? 1 : 0);
  for (const int sides : slice.sideSetSizes)
    sideTruth.insert(sideTruth.end(), extras.sideNames.size(), sides > 0 ? 1 : 0);
  const int sideNames = sideTruth.empty() ? 0 : int(extras.sideNames.size());
  checkExodus(ex_put_all_var_param(exoid, int(extras.globalNames.size()),
                                   int(extras.nodalNames.size()), int(extras.elementNames.size()),
                                   truth.data(), 0, nullptr, sideNames,
                                   sideNames > 0 ? sideTruth.data() : nullptr),
              "variables");
  const auto put = [&](ex_entity_type type, const std::vector<std::string>& list)
  {
    ExodusNames names(list);
    if (names.size() > 0)
      checkExodus(ex_put_variable_names(exoid, type, names.size(), names.data()), "variable names");
  };
  put(EX_GLOBAL, extras.globalNames);
  put(EX_NODAL, extras.nodalNames);
  put(EX_ELEM_BLOCK, extras.elementNames);
  if (sideNames > 0)
    put(EX_SIDE_SET, extras.sideNames);
}
} // namespace

GlobalId largestId(const MeshSlice& slice)
{
  GlobalId largest = 0;
  const auto consider = [&](GlobalId id) { largest = std::max(largest, id); };
  for (const GlobalId id : slice.mine.nodeIds)
    consider(id);
  for (const Mesh::Block& block : slice.mine.blocks)
  {
    consider(block.id);
    for (const GlobalId id : block.elementIds)
      consider(id);
  }
  for (const auto& set : slice.mine.nodeSets)
    consider(set.id);
  for (const auto& set : slice.mine.sideSets)
    consider(set.id);
  return largest;
}

int creationMode(GlobalId largestId)
{
  int mode = EX_CLOBBER | EX_64BIT_DATA | EX_ALL_INT64_API;
  if (largestId > std::numeric_limits<std::int32_t>::max())
    mode |= EX_ALL_INT64_DB;
  return mode;
}

namespace
{
void defineMesh(int exoid, const MeshSlice& slice, const FileExtras& extras)
{
  const Mesh& mesh = slice.mine;
  allowLongNames(exoid, mesh, extras);
  ex_init_params sizes{};
  copyText(sizes.title, mesh.title);
  sizes.num_dim = mesh.dimension;
  sizes.num_nodes = slice.nodes;
  sizes.num_elem = slice.elements();
  sizes.num_elem_blk = int64_t(mesh.blocks.size());
  sizes.num_node_sets = int64_t(mesh.nodeSets.size());
  sizes.num_side_sets = int64_t(mesh.sideSets.size());
  checkExodus(ex_put_init_ext(exoid, &sizes), "sizes");
  ExodusNames axes(mesh.dimension == 2 ? std::vector<std::string>{"x", "y"}
                                       : std::vector<std::string>{"x", "y", "z"});
  if (slice.nodes > 0)
    checkExodus(ex_put_coord_names(exoid, axes.data()), "axis names");
  defineBlocks(exoid, slice);
  defineSets(exoid, slice);
  putNames(exoid, EX_ELEM_BLOCK, mesh.blocks);
  putNames(exoid, EX_NODE_SET, mesh.nodeSets);
  putNames(exoid, EX_SIDE_SET, mesh.sideSets);
  putRecords(exoid, mesh, extras);
  putIds(exoid, slice);
  if (!extras.nodalNames.empty() || !extras.elementNames.empty() || !extras.globalNames.empty())
    defineVariables(exoid, slice, extras);
}
} // namespace

void defineFile(const std::string& file, const MeshSlice& slice, const FileExtras& extras, int mode)
{
  int memoryWord = 8, fileWord = 8;
  const int exoid = ex_create(file.c_str(), mode, &memoryWord, &fileWord);
  checkExodus(exoid, "creating the file");
  try
  {
    defineMesh(exoid, slice, extras);
  }
  catch (...)
  {
    ex_close(exoid);
    throw;
  }
  checkExodus(ex_close(exoid), "creating the file");
}

void writeMeshRanges(SharedFile& file, const MeshSlice& slice)
{
  const Mesh& mesh = slice.mine;
  const IndexRange nodes = slice.nodeRange();
  if (nodes.count > 0)
  {
    file.put("node_num_map", std::uint64_t(nodes.first), mesh.nodeIds);
    for (int axis = 0; axis < mesh.dimension; ++axis)
    {
      std::vector<Real> x;
      for (const Vec3& place : mesh.coordinates)
        x.push_back(place[axis]);
      file.put(fmt::format("coord{}", "xyz"[axis]), std::uint64_t(nodes.first), x);
    }
  }
  const auto oneMore = [](const std::vector<int>& values)
  {
    std::vector<ExodusInt> counted; // from 1
    for (const int value : values)
      counted.push_back(value + 1);
    return counted;
  };
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const Mesh::Block& block = mesh.blocks[b];
    const IndexRange mine = slice.elementRange(int(b));
    if (mine.count == 0)
      continue;
    std::vector<Real> bodies(block.bodyIds.begin(), block.bodyIds.end());
    bodies.resize(std::size_t(mine.count), 0);
    const std::uint64_t first = std::uint64_t(mine.first);
    file.put("elem_num_map", std::uint64_t(slice.firstElements[b]) + first, block.elementIds);
    file.put(fmt::format("connect{}", b + 1), first * std::uint64_t(topology(block.type).nodes),
             oneMore(block.connectivity));
    file.put(fmt::format("attrib{}", b + 1), first, bodies);
  }
  for (std::size_t s = 0; s < mesh.nodeSets.size(); ++s)
    if (const IndexRange mine = slice.rangeOf(slice.nodeSetSizes[s]); mine.count > 0)
      file.put(fmt::format("node_ns{}", s + 1), std::uint64_t(mine.first),
               oneMore(mesh.nodeSets[s].nodes));
  for (std::size_t s = 0; s < mesh.sideSets.size(); ++s)
    if (const IndexRange mine = slice.rangeOf(slice.sideSetSizes[s]); mine.count > 0)
    {
      file.put(fmt::format("elem_ss{}", s + 1), std::uint64_t(mine.first),
               oneMore(mesh.sideSets[s].elements));
      file.put(fmt::format("side_ss{}", s + 1), std::uint64_t(mine.first),
               oneMore(mesh.sideSets[s].sides));
    }
}

std::vector<std::string> splitInfoLines(const std::vector<std::string>& lines)
{
  std::vector<std::string> split;
  for (std::string rest : lines)
  {
    while (rest.size() > MAX_LINE_LENGTH)
    {
      split.push_back(rest.substr(0, MAX_LINE_LENGTH));
      rest = "> " + rest.substr(MAX_LINE_LENGTH);
    }
    split.push_back(rest);
  }
  return split;
}
} // namespace coplane
