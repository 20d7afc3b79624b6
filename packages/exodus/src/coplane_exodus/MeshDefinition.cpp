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

GlobalId largestId(const Mesh& mesh)
{
  GlobalId largest = 0;
  const auto consider = [&](GlobalId id) { largest = std::max(largest, id); };
  for (const GlobalId id : mesh.nodeIds)
    consider(id);
  for (const Mesh::Block& block : mesh.blocks)
  {
    consider(block.id);
    for (const GlobalId id : block.elementIds)
      consider(id);
  }
  for (const auto& set : mesh.nodeSets)
    consider(set.id);
  for (const auto& set : mesh.sideSets)
    consider(set.id);
  return largest;
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

void defineBlocks(int exoid, const Mesh& mesh)
{
  std::vector<ex_block> blocks;
  for (const Mesh::Block& block : mesh.blocks)
  {
    ex_block b{};
    b.id = block.id;
    b.type = EX_ELEM_BLOCK;
    copyText(b.topology, topology(block.type).exodusName);
    b.num_entry = block.elements();
    b.num_nodes_per_entry = topology(block.type).nodes;
    b.num_attribute = 1;
    blocks.push_back(b);
  }
  if (!blocks.empty())
    checkExodus(ex_put_block_params(exoid, blocks.size(), blocks.data()), "element blocks");
  for (const Mesh::Block& block : mesh.blocks)
    if (block.elements() > 0)
    {
      ExodusNames names({"body_id"});
      checkExodus(ex_put_attr_names(exoid, EX_ELEM_BLOCK, block.id, names.data()),
                  "attribute names");
    }
}

void defineSets(int exoid, const Mesh& mesh)
{
  std::vector<ex_set> sets;
  const auto add = [&](ex_entity_type type, GlobalId id, std::size_t entries)
  {
    ex_set s{};
    s.id = id;
    s.type = type;
    s.num_entry = int64_t(entries);
    sets.push_back(s);
  };
  for (const Mesh::NodeSet& set : mesh.nodeSets)
    add(EX_NODE_SET, set.id, set.nodes.size());
  for (const Mesh::SideSet& set : mesh.sideSets)
    add(EX_SIDE_SET, set.id, set.elements.size());
  if (!sets.empty())
    checkExodus(ex_put_sets(exoid, sets.size(), sets.data()), "node and side sets");
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

void defineVariables(int exoid, const Mesh& mesh, const FileExtras& extras)
{
  std::vector<int> truth, sideTruth;
  for (const Mesh::Block& block : mesh.blocks)
    truth.insert(truth.end(), extras.elementNames.size(), block.elements() > 0 ? 1 : 0);
  for (const Mesh::SideSet& set : mesh.sideSets)
    sideTruth.insert(sideTruth.end(), extras.sideNames.size(), set.sides.empty() ? 0 : 1);
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

int creationMode(const Mesh& mesh)
{
  int mode = EX_CLOBBER | EX_64BIT_DATA | EX_ALL_INT64_API;
  if (largestId(mesh) > std::numeric_limits<std::int32_t>::max())
    mode |= EX_ALL_INT64_DB;
  return mode;
}

void defineMesh(int exoid, const Mesh& mesh, const FileExtras& extras)
{
  allowLongNames(exoid, mesh, extras);
  ex_init_params sizes{};
  copyText(sizes.title, mesh.title);
  sizes.num_dim = mesh.dimension;
  sizes.num_nodes = mesh.nodes();
  sizes.num_elem = mesh.elements();
  sizes.num_elem_blk = int64_t(mesh.blocks.size());
  sizes.num_node_sets = int64_t(mesh.nodeSets.size());
  sizes.num_side_sets = int64_t(mesh.sideSets.size());
  checkExodus(ex_put_init_ext(exoid, &sizes), "sizes");
  ExodusNames axes(mesh.dimension == 2 ? std::vector<std::string>{"x", "y"}
                                       : std::vector<std::string>{"x", "y", "z"});
  if (mesh.nodes() > 0)
    checkExodus(ex_put_coord_names(exoid, axes.data()), "axis names");
  defineBlocks(exoid, mesh);
  defineSets(exoid, mesh);
  putNames(exoid, EX_ELEM_BLOCK, mesh.blocks);
  putNames(exoid, EX_NODE_SET, mesh.nodeSets);
  putNames(exoid, EX_SIDE_SET, mesh.sideSets);
  putRecords(exoid, mesh, extras);

  std::vector<GlobalId> elementIds;
  for (const Mesh::Block& block : mesh.blocks)
    elementIds.insert(elementIds.end(), block.elementIds.begin(), block.elementIds.end());
  if (mesh.nodes() > 0)
    checkExodus(ex_put_id_map(exoid, EX_NODE_MAP, mesh.nodeIds.data()), "node ids");
  if (!elementIds.empty())
    checkExodus(ex_put_id_map(exoid, EX_ELEM_MAP, elementIds.data()), "element ids");

  if (!extras.nodalNames.empty() || !extras.elementNames.empty() || !extras.globalNames.empty())
    defineVariables(exoid, mesh, extras);
}

void writeMeshRanges(int exoid, const Mesh& mesh, int rank, int ranks)
{
  if (const IndexRange mine = contiguousRange(mesh.nodes(), rank, ranks); mine.count > 0)
  {
    std::vector<Real> x[3];
    for (int i = mine.first; i < mine.first + mine.count; ++i)
      for (int k = 0; k < 3; ++k)
        x[k].push_back(mesh.coordinates[i][k]);
    checkExodus(ex_put_partial_coord(exoid, mine.first + 1, mine.count, x[0].data(), x[1].data(),
                                     mesh.dimension == 3 ? x[2].data() : nullptr),
                "coordinates");
  }
  for (const Mesh::Block& block : mesh.blocks)
  {
    const IndexRange mine = contiguousRange(block.elements(), rank, ranks);
    if (mine.count == 0)
      continue;
    const int perElement = topology(block.type).nodes;
    std::vector<ExodusInt> nodes;
    std::vector<Real> bodies;
    for (int e = mine.first; e < mine.first + mine.count; ++e)
    {
      for (int k = 0; k < perElement; ++k)
        nodes.push_back(block.connectivity[e * perElement + k] + 1);
      bodies.push_back(block.bodyIds.empty() ? 0 : block.bodyIds[e]);
    }
    checkExodus(ex_put_partial_conn(exoid, EX_ELEM_BLOCK, block.id, mine.first + 1, mine.count,
                                    nodes.data(), nullptr, nullptr),
                "connectivity");
    checkExodus(ex_put_partial_one_attr(exoid, EX_ELEM_BLOCK, block.id, mine.first + 1, mine.count,
                                        1, bodies.data()),
                "attribute body_id");
  }
  const auto putSet = [&](ex_entity_type type, GlobalId id, const std::vector<int>& first,
                          const std::vector<int>* second)
  {
    const IndexRange mine = contiguousRange(int(first.size()), rank, ranks);
    if (mine.count == 0)
      return;
    std::vector<ExodusInt> entries, extra;
    for (int i = mine.first; i < mine.first + mine.count; ++i)
    {
      entries.push_back(first[i] + 1);
      if (second)
        extra.push_back((*second)[i] + 1);
    }
    checkExodus(ex_put_partial_set(exoid, type, id, mine.first + 1, mine.count, entries.data(),
                                   second ? extra.data() : nullptr),
                "set entries");
  };
  for (const Mesh::NodeSet& set : mesh.nodeSets)
    putSet(EX_NODE_SET, set.id, set.nodes, nullptr);
  for (const Mesh::SideSet& set : mesh.sideSets)
    putSet(EX_SIDE_SET, set.id, set.elements, &set.sides);
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
