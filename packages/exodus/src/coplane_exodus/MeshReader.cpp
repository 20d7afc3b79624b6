#include <coplane_core/Error.hpp>
#include <coplane_core/Text.hpp>
#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/detail/FileProbe.hpp>
#include <coplane_exodus/detail/MeshReader.hpp>

#include <exodusII.h>
#include <netcdf.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <unordered_map>

namespace coplane
{
namespace
{
std::string upperCase(std::string text)
{
  for (char& c : text)
    c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// One open Exodus file and the steps of reading a slice of it.
class Reader
{
public:
  Reader(const std::string& file, bool isPart, int rank, int ranks) : file_(file), isPart_(isPart)
  {
    quietExodus();
    int memoryWord = 8, fileWord = 0;
    float version = 0;
    exoid_ = ex_open(file.c_str(), EX_READ | EX_ALL_INT64_API, &memoryWord, &fileWord, &version);
    if (exoid_ < 0)
      refuseMeshFile(file);
    ex_set_max_name_length(
        exoid_, int(std::max<int64_t>(ex_inquire_int(exoid_, EX_INQ_DB_MAX_USED_NAME_LENGTH), 32)));
    slice_.rank = rank;
    slice_.ranks = ranks;
  }
  ~Reader() { ex_close(exoid_); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  ReadSlice read()
  {
    demandLists();
    readSizes();
    readNodes();
    readBlocks();
    readElementIds();
    readNodeSets();
    readSideSets();
    readQaRecords();
    return {std::move(slice_), std::move(blockIds_)};
  }

private:
  void check(int status, const std::string& what) const
  {
    try
    {
      checkExodus(status, what);
    }
    catch (const ExodusFailure& failure)
    {
      fail(ExitCode::Mesh, "{}: cannot be read: {}. The file is damaged; write it again.", file_,
           failure.what());
    }
  }

  /// The lists of ids and states of blocks and sets, as Exodus 8 reads them: without a look at
  /// their length, and when it cannot read one it frees it twice.
  void demandLists() const
  {
    for (const auto& [kind, dimension] :
         {std::pair("eb", "num_el_blk"), {"ns", "num_node_sets"}, {"ss", "num_side_sets"}})
      for (const char* list : {"_prop1", "_status"})
      {
        int variable = -1, dimensions = 0, own = -1, whole = -1;
        nc_type type = NC_NAT;
        if (nc_inq_varid(exoid_, (std::string(kind) + list).c_str(), &variable) != NC_NOERR)
          continue;
        const bool isInt = nc_inq_vartype(exoid_, variable, &type) == NC_NOERR &&
                           (type == NC_INT || (type == NC_INT64 && list[1] == 'p'));
        if (!isInt || nc_inq_varndims(exoid_, variable, &dimensions) != NC_NOERR ||
            dimensions != 1 || nc_inq_vardimid(exoid_, variable, &own) != NC_NOERR ||
            nc_inq_dimid(exoid_, dimension, &whole) != NC_NOERR || own != whole)
          fail(ExitCode::Mesh,
               "{}: the list '{}{}' is not one of whole numbers, one for each of '{}'. The file is "
               "damaged; write it again.",
               file_, kind, list, dimension);
      }
  }

  void readSizes()
  {
    ex_init_params sizes{};
    if (ex_get_init_ext(exoid_, &sizes) < 0)
      fail(ExitCode::Mesh,
           "{}: the file is netCDF but holds no Exodus II mesh. Export Exodus II from your mesh "
           "generator.",
           file_);
    if (sizes.num_dim != 2 && sizes.num_dim != 3)
      fail(ExitCode::Mesh, "{}: the mesh has {} dimensions; 2 and 3 are accepted.", file_,
           sizes.num_dim);
    if ((sizes.num_elem == 0 || sizes.num_nodes == 0) && !isPart_)
      fail(ExitCode::Mesh,
           "{}: the mesh has no elements ({} nodes, {} element blocks). Export the element blocks "
           "too.",
           file_, sizes.num_nodes, sizes.num_elem_blk);
    if (std::max(sizes.num_elem, sizes.num_nodes) > most)
      fail(ExitCode::Mesh,
           "{}: the mesh has {} nodes and {} elements; up to {} of each are accepted.", file_,
           sizes.num_nodes, sizes.num_elem, most);
    mesh_.title = sizes.title;
    mesh_.dimension = int(sizes.num_dim);
    slice_.nodes = int(sizes.num_nodes);
    elements_ = sizes.num_elem;
    blocks_ = sizes.num_elem_blk;
    nodeSets_ = sizes.num_node_sets;
    sideSets_ = sizes.num_side_sets;
  }

  void readNodes()
  {
    const IndexRange range = slice_.nodeRange();
    if (range.count == 0)
      return;
    mesh_.nodeIds.resize(range.count);
    check(ex_get_partial_id_map(exoid_, EX_NODE_MAP, range.first + 1, range.count,
                                mesh_.nodeIds.data()),
          "node ids");
    std::vector<Real> x(range.count), y(range.count), z(range.count, 0.0);
    check(ex_get_partial_coord(exoid_, range.first + 1, range.count, x.data(), y.data(),
                               mesh_.dimension == 3 ? z.data() : nullptr),
          "coordinates");
    mesh_.coordinates.resize(range.count);
    for (int i = 0; i < range.count; ++i)
    {
      mesh_.coordinates[i] = {x[i], y[i], z[i]};
      if (!std::isfinite(x[i]) || !std::isfinite(y[i]) || !std::isfinite(z[i]))
        fail(ExitCode::Mesh,
             "{}: node {} is at ({}, {}, {}) m; coordinates must be finite. Repair the mesh.",
             file_, mesh_.nodeIds[i], x[i], y[i], z[i]);
    }
  }

  ElementType elementType(const ex_block& b, const std::string& name) const
  {
    struct Known
    {
      ElementType type;
      std::vector<std::string> names;
    };
    static const Known known[] = {{ElementType::Tri3, {"TRI", "TRI3", "TRIANGLE"}},
                                  {ElementType::Quad4, {"QUAD", "QUAD4"}},
                                  {ElementType::Tet4, {"TET", "TET4", "TETRA", "TETRA4"}},
                                  {ElementType::Hex8, {"HEX", "HEX8"}}};
    const std::string written = upperCase(b.topology);
    for (const Known& candidate : known)
    {
      const ElementTopology& shape = topology(candidate.type);
      if (b.num_nodes_per_entry != shape.nodes ||
          std::find(candidate.names.begin(), candidate.names.end(), written) ==
              candidate.names.end())
        continue;
      if (shape.dimension != mesh_.dimension)
        fail(ExitCode::Mesh,
             "{}: block {} ('{}') has {} elements in a mesh of {} dimensions; TRI3 and QUAD4 need "
             "2 dimensions, TETRA4 and HEX8 need 3. Export the mesh with {} coordinates per node.",
             file_, b.id, name, b.topology, mesh_.dimension, shape.dimension);
      return candidate.type;
    }
    fail(ExitCode::Mesh,
         "{}: block {} ('{}') has elements of type '{}' with {} nodes; accepted are TRI3 (also "
         "TRI, TRIANGLE) with 3 nodes and QUAD4 (also QUAD) with 4 in two dimensions, TETRA4 (also "
         "TETRA, TET4, TET) with 4 and HEX8 (also HEX) with 8 in three. Mesh this block with such "
         "elements.",
         file_, b.id, name, b.topology, b.num_nodes_per_entry);
  }

  void readBlocks()
  {
    std::vector<ExodusInt> ids(blocks_);
    check(ex_get_ids(exoid_, EX_ELEM_BLOCK, ids.data()), "block ids");
    checkIds("element block", ids);
    blockIds_.assign(ids.begin(), ids.end());
    for (const ExodusInt id : ids)
    {
      ex_block b{};
      b.id = id;
      b.type = EX_ELEM_BLOCK;
      check(ex_get_block_param(exoid_, &b), "element block");
      if (b.num_entry == 0 && b.num_nodes_per_entry == 0)
        continue;
      Mesh::Block block;
      block.id = id;
      block.name = nameOf(EX_ELEM_BLOCK, id, "block");
      block.type = elementType(b, block.name);
      if (b.num_entry < 0 || b.num_entry > elements_ - slice_.elements())
        fail(ExitCode::Mesh,
             "{}: the element blocks up to {} ('{}') have more elements than the mesh, which has "
             "{}. Write the file again.",
             file_, block.id, block.name, elements_);
      const IndexRange range = slice_.rangeOf(int(b.num_entry));
      readConnectivity(block, range);
      readBodyIds(block, b, range);
      slice_.firstElements.push_back(slice_.elements() + int(b.num_entry));
      mesh_.blocks.push_back(std::move(block));
    }
    checkNames("element blocks", mesh_.blocks);
  }

  void readConnectivity(Mesh::Block& block, IndexRange range) const
  {
    block.elementIds.resize(range.count);
    if (range.count == 0)
      return;
    std::vector<ExodusInt> nodes(std::size_t(range.count) * topology(block.type).nodes);
    check(ex_get_partial_conn(exoid_, EX_ELEM_BLOCK, block.id, range.first + 1, range.count,
                              nodes.data(), nullptr, nullptr),
          "connectivity");
    block.connectivity.reserve(nodes.size());
    for (const ExodusInt node : nodes)
    {
      if (node < 1 || node > slice_.nodes)
        fail(ExitCode::Mesh,
             "{}: an element of block {} ('{}') uses node number {}; the mesh has nodes 1 to {}. "
             "Write the file again.",
             file_, block.id, block.name, node, slice_.nodes);
      block.connectivity.push_back(int(node - 1));
    }
  }

  void readBodyIds(Mesh::Block& block, const ex_block& b, IndexRange range) const
  {
    block.bodyIds.assign(range.count, 0);
    if (b.num_attribute == 0 || range.count == 0)
      return;
    const int length = int(ex_inquire_int(exoid_, EX_INQ_MAX_READ_NAME_LENGTH));
    ExodusNames names(std::vector<std::string>(b.num_attribute, std::string(length + 1, '\0')));
    check(ex_get_attr_names(exoid_, EX_ELEM_BLOCK, block.id, names.data()), "attribute names");
    for (int a = 0; a < int(b.num_attribute); ++a)
      if (upperCase(names.data()[a]) == "BODY_ID")
      {
        std::vector<Real> values(range.count);
        check(ex_get_partial_one_attr(exoid_, EX_ELEM_BLOCK, block.id, range.first + 1, range.count,
                                      a + 1, values.data()),
              "attribute body_id");
        for (int e = 0; e < range.count; ++e)
          block.bodyIds[e] = int(std::lround(values[e]));
      }
  }

  void readElementIds()
  {
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
      if (const IndexRange range = slice_.elementRange(int(b)); range.count > 0)
        check(ex_get_partial_id_map(exoid_, EX_ELEM_MAP, slice_.firstElements[b] + range.first + 1,
                                    range.count, mesh_.blocks[b].elementIds.data()),
              "element ids");
  }

  /// This rank's range of the entries of a set.
  IndexRange readSet(ex_entity_type type, GlobalId id, const char* what, std::vector<int>& sizes,
                     std::vector<ExodusInt>& entries, std::vector<ExodusInt>& sides) const
  {
    int64_t count = 0, factors = 0;
    check(ex_get_set_param(exoid_, type, id, &count, &factors), "set");
    if (count < 0 || count > most)
      fail(ExitCode::Mesh, "{}: {} {} has {} entries; up to {} are accepted.", file_, what, id,
           count, most);
    sizes.push_back(int(count));
    const IndexRange range = slice_.rangeOf(int(count));
    entries.resize(range.count);
    sides.resize(range.count);
    if (range.count > 0)
      check(ex_get_partial_set(exoid_, type, id, range.first + 1, range.count, entries.data(),
                               type == EX_SIDE_SET ? sides.data() : nullptr),
            what);
    return range;
  }

  void readNodeSets()
  {
    for (const ExodusInt id : setIds(EX_NODE_SET, "node set", nodeSets_))
    {
      Mesh::NodeSet set;
      set.id = id;
      set.name = nameOf(EX_NODE_SET, id, "nodelist");
      std::vector<ExodusInt> nodes, unused;
      readSet(EX_NODE_SET, id, "node set", slice_.nodeSetSizes, nodes, unused);
      for (const ExodusInt node : nodes)
      {
        if (node < 1 || node > slice_.nodes)
          fail(ExitCode::Mesh,
               "{}: node set {} ('{}') lists node number {}; the mesh has nodes 1 to {}. Write the "
               "file again.",
               file_, id, set.name, node, slice_.nodes);
        set.nodes.push_back(int(node - 1));
      }
      mesh_.nodeSets.push_back(std::move(set));
    }
    checkNames("node sets", mesh_.nodeSets);
  }

  void readSideSets()
  {
    for (const ExodusInt id : setIds(EX_SIDE_SET, "side set", sideSets_))
    {
      Mesh::SideSet set;
      set.id = id;
      set.name = nameOf(EX_SIDE_SET, id, "surface");
      std::vector<ExodusInt> elements, sides;
      readSet(EX_SIDE_SET, id, "side set", slice_.sideSetSizes, elements, sides);
      for (std::size_t i = 0; i < elements.size(); ++i)
      {
        if (elements[i] < 1 || elements[i] > slice_.elements())
          fail(ExitCode::Mesh,
               "{}: side set {} ('{}') lists a side of element number {}; elements 1 to {} exist. "
               "Write the file again.",
               file_, id, set.name, elements[i], slice_.elements());
        const auto [block, element] = slice_.placeOf(int(elements[i] - 1));
        if (const int count = topology(mesh_.blocks[block].type).sides;
            sides[i] < 1 || sides[i] > count)
          fail(ExitCode::Mesh,
               "{}: side set {} ('{}') lists side {} of element number {}, which has sides 1 to "
               "{}. Write the file again.",
               file_, id, set.name, sides[i], elements[i], count);
        set.elements.push_back(int(elements[i] - 1));
        set.sides.push_back(int(sides[i] - 1));
      }
      mesh_.sideSets.push_back(std::move(set));
    }
    checkNames("side sets", mesh_.sideSets);
  }

  void readQaRecords()
  {
    const int count = int(ex_inquire_int(exoid_, EX_INQ_QA));
    if (count <= 0)
      return;
    std::vector<ExodusNames> texts;
    using Record = char* [4];
    const auto records = std::make_unique<Record[]>(count);
    texts.reserve(count);
    for (int i = 0; i < count; ++i)
    {
      texts.emplace_back(std::vector<std::string>(4, std::string(MAX_STR_LENGTH + 1, '\0')));
      for (int k = 0; k < 4; ++k)
        records[i][k] = texts[i].data()[k];
    }
    check(ex_get_qa(exoid_, records.get()), "QA records");
    for (int i = 0; i < count; ++i)
      mesh_.qaRecords.push_back({records[i][0], records[i][1], records[i][2], records[i][3]});
  }

  std::vector<ExodusInt> setIds(ex_entity_type type, const char* what, int64_t count) const
  {
    std::vector<ExodusInt> ids(count);
    if (count > 0)
      check(ex_get_ids(exoid_, type, ids.data()), what);
    checkIds(what, ids);
    return ids;
  }

  std::string nameOf(ex_entity_type type, GlobalId id, const char* kind) const
  {
    std::string name(ex_inquire_int(exoid_, EX_INQ_MAX_READ_NAME_LENGTH) + 1, '\0');
    check(ex_get_name(exoid_, type, id, name.data()), "names");
    name.resize(std::char_traits<char>::length(name.c_str()));
    return name.empty() ? fmt::format("{}_{}", kind, id) : asUtf8(name);
  }

  void checkIds(const char* what, const std::vector<GlobalId>& ids) const
  {
    std::vector<GlobalId> sorted = ids;
    std::sort(sorted.begin(), sorted.end());
    if (!sorted.empty() && sorted.front() < 1)
      fail(ExitCode::Mesh, "{}: {} id {} is not positive. Renumber the mesh with ids from 1.",
           file_, what, sorted.front());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end())
      fail(ExitCode::Mesh,
           "{}: {} id {} occurs more than once; ids must be unique. Renumber the mesh.", file_,
           what, *twice);
  }

  template <class Entities>
  void checkNames(const char* what, const Entities& entities) const
  {
    std::unordered_map<std::string, GlobalId> idOfName;
    for (const auto& entity : entities)
      if (const auto [other, added] = idOfName.emplace(entity.name, entity.id); !added)
        fail(ExitCode::Mesh,
             "{}: {} {} and {} are both named '{}'; names must be unique. Rename one.", file_, what,
             other->second, entity.id, entity.name);
  }

  /// Positions are ints.
  static constexpr int64_t most = (int64_t(1) << 31) - 2;

  std::string file_;
  bool isPart_;
  int exoid_ = -1;
  MeshSlice slice_;
  Mesh& mesh_ = slice_.mine;
  std::vector<GlobalId> blockIds_;
  int64_t elements_ = 0, blocks_ = 0, nodeSets_ = 0, sideSets_ = 0;
};

} // namespace

ReadSlice readSliceOfFile(const std::string& file, bool isPart, int rank, int ranks)
{
  return Reader(file, isPart, rank, ranks).read();
}

void probeMeshFile(const std::string& file)
{
  constexpr int ranks = 1 << 20; // so that this one reads little
  try
  {
    Reader(file, true, 0, ranks).read();
  }
  catch (const Error&) // told by who reads the whole
  {
  }
}
} // namespace coplane
