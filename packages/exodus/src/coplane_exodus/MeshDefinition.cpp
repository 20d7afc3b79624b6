#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/MeshDefinition.hpp>

#include <exodusII.h>

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

void writeMeshRanges(int exoid, const MeshSlice& slice)
{
  const Mesh& mesh = slice.mine;
  if (slice.rank > 0)
    putIds(exoid, slice);
  if (const IndexRange mine = slice.nodeRange(); mine.count > 0)
  {
    std::vector<Real> x[3];
    for (int k = 0; k < 3; ++k)
      for (const Vec3& place : mesh.coordinates)
        x[k].push_back(place[k]);
    checkExodus(ex_put_partial_coord(exoid, mine.first + 1, mine.count, x[0].data(), x[1].data(),
                                     mesh.dimension == 3 ? x[2].data() : nullptr),
                "coordinates");
  }
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const Mesh::Block& block = mesh.blocks[b];
    const IndexRange mine = slice.elementRange(int(b));
    if (mine.count == 0)
      continue;
    std::vector<ExodusInt> nodes;
    nodes.reserve(block.connectivity.size());
    for (const int node : block.connectivity)
      nodes.push_back(node + 1);
    std::vector<Real> bodies(block.bodyIds.begin(), block.bodyIds.end());
    bodies.resize(std::size_t(mine.count), 0);
    checkExodus(ex_put_partial_conn(exoid, EX_ELEM_BLOCK, block.id, mine.first + 1, mine.count,
                                    nodes.data(), nullptr, nullptr),
                "connectivity");
    checkExodus(ex_put_partial_one_attr(exoid, EX_ELEM_BLOCK, block.id, mine.first + 1, mine.count,
                                        1, bodies.data()),
                "attribute body_id");
  }
  const auto putSet = [&](ex_entity_type type, GlobalId id, int size, const std::vector<int>& first,
                          const std::vector<int>* second)
  {
    const IndexRange mine = slice.rangeOf(size);
    if (mine.count == 0)
      return;
    std::vector<ExodusInt> entries, extra;
    for (const int entry : first)
      entries.push_back(entry + 1);
    if (second)
      for (const int side : *second)
        extra.push_back(side + 1);
    checkExodus(ex_put_partial_set(exoid, type, id, mine.first + 1, mine.count, entries.data(),
                                   second ? extra.data() : nullptr),
                "set entries");
  };
  for (std::size_t s = 0; s < mesh.nodeSets.size(); ++s)
    putSet(EX_NODE_SET, mesh.nodeSets[s].id, slice.nodeSetSizes[s], mesh.nodeSets[s].nodes,
           nullptr);
  for (std::size_t s = 0; s < mesh.sideSets.size(); ++s)
    putSet(EX_SIDE_SET, mesh.sideSets[s].id, slice.sideSetSizes[s], mesh.sideSets[s].elements,
           &mesh.sideSets[s].sides);
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
