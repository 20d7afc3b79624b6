#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/SortOverRanks.hpp>
#include <coplane_exodus/detail/MeshParts.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>

namespace coplane
{
namespace
{
bool isNumber(const std::string& text)
{
  return !text.empty() && text.size() < 9 &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

/// A block or a set of some part.
struct Entity
{
  enum Kind
  {
    Block,
    NodeSet,
    SideSet
  };
  int kind = Block;
  bool isThere = false; ///< the part's reader has found it; else only its id is known
  bool isFilled = false;
  ElementType type = ElementType::Hex8;
  GlobalId id = 0;
  char name[512] = {};
};

struct Node
{
  GlobalId id = 0;
  Vec3 x{};
};

struct Element
{
  GlobalId id = 0;
  int body = 0;
  std::array<int, 8> nodes{};
};

/// What an id stands for in the whole mesh.
struct Place
{
  GlobalId id = 0;
  int position = 0;
};

/// Items that are sorted over the ranks, dealt out anew so that every rank has its range of them.
template <class T>
std::vector<T> inRanges(const std::vector<T>& sorted, int& total, const Comm& comm)
{
  const Share share(sorted.size(), comm);
  total = int(share.total);
  std::vector<std::vector<T>> toRank(comm.size());
  for (std::size_t i = 0; i < sorted.size(); ++i)
    toRank[rankOfItem(int(share.before) + int(i), total, comm.size())].push_back(sorted[i]);
  return comm.exchange(toRank);
}

/// Answers which position an id has in the whole mesh, for ids that some part has.
class Directory
{
public:
  Directory(const std::vector<Place>& places, const Comm& comm)
      : comm_(comm), ranges_(places, idOf, comm),
        sorted_(sortOverRanks(places, idOf, ranges_, comm))
  {
  }

  /// Collective.
  std::vector<int> positions(const std::vector<GlobalId>& ids) const
  {
    std::vector<std::vector<GlobalId>> questions(comm_.size());
    for (const GlobalId id : ids)
      questions[ranges_.rankOf(id)].push_back(id);
    std::vector<int> counts;
    const std::vector<GlobalId> asked = comm_.exchange(questions, &counts);
    std::vector<std::vector<int>> answers(comm_.size());
    auto next = asked.begin();
    for (int r = 0; r < comm_.size(); ++r)
      for (int i = 0; i < counts[r]; ++i, ++next)
        answers[r].push_back(std::lower_bound(sorted_.begin(), sorted_.end(), *next,
                                              [](const Place& place, GlobalId id)
                                              { return place.id < id; })
                                 ->position);
    const std::vector<int> found = comm_.exchange(answers, &counts);
    std::vector<std::size_t> begin(comm_.size(), 0);
    for (int r = 1; r < comm_.size(); ++r)
      begin[r] = begin[r - 1] + std::size_t(counts[r - 1]);
    std::vector<int> positions;
    for (const GlobalId id : ids)
      positions.push_back(found[begin[ranges_.rankOf(id)]++]);
    return positions;
  }

private:
  static GlobalId idOf(const Place& place) { return place.id; }

  const Comm& comm_;
  KeyRanges ranges_;
  std::vector<Place> sorted_;
};

template <class T>
const T* withId(const std::vector<T>& entities, GlobalId id)
{
  const auto found = std::find_if(entities.begin(), entities.end(),
                                  [&](const T& entity) { return entity.id == id; });
  return found == entities.end() ? nullptr : &*found;
}

/// Puts the parts of a mesh together; each step is collective.
class Merger
{
public:
  Merger(const std::vector<Mesh>& parts, const std::vector<GlobalId>& blockOrder,
         const std::string& file, const Comm& comm)
      : parts_(parts), file_(file), comm_(comm)
  {
    slice_.rank = comm.rank();
    slice_.ranks = comm.size();
    readHead();
    gatherEntities(blockOrder);
  }

  MeshSlice merge()
  {
    mergeNodes();
    mergeBlocks();
    mergeNodeSets();
    mergeSideSets();
    return std::move(slice_);
  }

private:
  /// Title, QA records and dimension are those of the first part, which the first rank has.
  void readHead()
  {
    Mesh& mesh = slice_.mine;
    std::string title;
    std::vector<std::string> records;
    std::int64_t count = 0;
    if (comm_.isRoot())
    {
      title = parts_[0].title;
      count = std::int64_t(parts_[0].qaRecords.size());
      mesh.qaRecords = parts_[0].qaRecords;
      mesh.dimension = parts_[0].dimension;
    }
    mesh.title = comm_.broadcast(title);
    mesh.qaRecords.resize(std::size_t(comm_.max(count)));
    for (auto& record : mesh.qaRecords)
      for (std::string& text : record)
        text = comm_.broadcast(text);
    mesh.dimension = int(comm_.max(std::int64_t(comm_.isRoot() ? mesh.dimension : 0)));
    std::int64_t other = 0;
    for (const Mesh& part : parts_)
      if (part.dimension != mesh.dimension)
        other = part.dimension;
    if (other = comm_.max(other); other > 0)
      failOnAllRanks(ExitCode::Mesh,
                     "{}: its parts have {} and {} dimensions; they are of two meshes.", file_,
                     mesh.dimension, other);
  }

  template <class T>
  static Entity entityOf(Entity::Kind kind, const T& item)
  {
    Entity entity;
    entity.kind = kind;
    entity.isThere = true;
    entity.id = item.id;
    item.name.copy(entity.name, sizeof entity.name - 1);
    return entity;
  }

  /// The blocks and sets of all parts, each once, in the order in which they occur first.
  void gatherEntities(const std::vector<GlobalId>& blockOrder)
  {
    std::vector<Entity> mine;
    for (const GlobalId id : blockOrder)
    {
      Entity entity;
      entity.id = id;
      mine.push_back(entity);
    }
    for (const Mesh& part : parts_)
    {
      for (const Mesh::Block& block : part.blocks)
      {
        mine.push_back(entityOf(Entity::Block, block));
        mine.back().type = block.type;
        mine.back().isFilled = block.elements() > 0;
      }
      for (const Mesh::NodeSet& set : part.nodeSets)
        mine.push_back(entityOf(Entity::NodeSet, set));
      for (const Mesh::SideSet& set : part.sideSets)
        mine.push_back(entityOf(Entity::SideSet, set));
    }
    for (const Entity& entity : comm_.allGather(united(mine)))
      unite(entity, entities_);
    for (const Entity& entity : entities_)
      if (entity.isThere && entity.kind == Entity::Block)
        slice_.mine.blocks.push_back({entity.id, entity.name, entity.type, {}, {}, {}});
      else if (entity.kind == Entity::NodeSet)
        slice_.mine.nodeSets.push_back({entity.id, entity.name, {}});
      else if (entity.kind == Entity::SideSet)
        slice_.mine.sideSets.push_back({entity.id, entity.name, {}, {}});
  }

  std::vector<Entity> united(const std::vector<Entity>& all)
  {
    std::vector<Entity> result;
    for (const Entity& entity : all)
      unite(entity, result);
    return result;
  }

  /// Blocks without elements tell nothing of their shape.
  void unite(const Entity& entity, std::vector<Entity>& all)
  {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Entity& other)
                                    { return other.kind == entity.kind && other.id == entity.id; });
    if (found == all.end())
      all.push_back(entity);
    else if (!found->isThere || (!found->isFilled && entity.isFilled))
      *found = entity;
    else if (entity.isFilled && entity.type != found->type)
      twoShapes_ = std::max(twoShapes_, entity.id);
  }

  void mergeNodes()
  {
    if (const GlobalId block = comm_.max(twoShapes_); block > 0)
      failOnAllRanks(
          ExitCode::Mesh,
          "{}: block {} has elements of two shapes in its parts; they are of two meshes.", file_,
          block);
    std::vector<Node> all;
    for (const Mesh& part : parts_)
      for (int n = 0; n < part.nodes(); ++n)
        all.push_back({part.nodeIds[n], part.coordinates[n]});
    const auto idOf = [](const Node& node) { return node.id; };
    std::vector<Node> nodes = sortOverRanks(all, idOf, KeyRanges(all, idOf, comm_), comm_);
    std::int64_t torn = INT64_MAX; // the lowest node with two places
    const auto same = [&](const Node& a, const Node& b)
    {
      const Vec3 apart = a.x - b.x;
      if (a.id == b.id && !(dot(apart, apart) == 0))
        torn = std::min(torn, std::int64_t(a.id));
      return a.id == b.id;
    };
    nodes.erase(std::unique(nodes.begin(), nodes.end(), same), nodes.end());
    if (torn = comm_.min(torn); torn < INT64_MAX)
      failOnAllRanks(ExitCode::Mesh,
                     "{}: node {} lies at different places in two of its parts; they are of two "
                     "meshes. Split the mesh again.",
                     file_, torn);
    std::vector<Place> places;
    for (const Node& node : inRanges(nodes, slice_.nodes, comm_))
    {
      places.push_back({node.id, slice_.nodeRange().first + int(places.size())});
      slice_.mine.nodeIds.push_back(node.id);
      slice_.mine.coordinates.push_back(node.x);
    }
    const Directory directory(places, comm_);
    std::vector<GlobalId> ids;
    for (const Mesh& part : parts_)
      ids.insert(ids.end(), part.nodeIds.begin(), part.nodeIds.end());
    positions_ = directory.positions(ids);
    int first = 0;
    for (const Mesh& part : parts_)
    {
      firstNodes_.push_back(first);
      first += part.nodes();
    }
  }

  /// Place in the whole mesh of a node of a part.
  int position(std::size_t part, int node) const { return positions_[firstNodes_[part] + node]; }

  void mergeBlocks()
  {
    std::vector<Place> places;
    for (Mesh::Block& block : slice_.mine.blocks)
    {
      const int corners = topology(block.type).nodes;
      std::vector<Element> all;
      for (std::size_t p = 0; p < parts_.size(); ++p)
        if (const Mesh::Block* one = withId(parts_[p].blocks, block.id))
          for (int e = 0; e < one->elements(); ++e)
          {
            all.push_back({one->elementIds[e], one->bodyIds[e], {}});
            for (int k = 0; k < corners; ++k)
              all.back().nodes[k] = position(p, one->connectivity[std::size_t(e) * corners + k]);
          }
      const auto idOf = [](const Element& element) { return element.id; };
      int total = 0;
      const std::vector<Element> mine =
          inRanges(sortOverRanks(all, idOf, KeyRanges(all, idOf, comm_), comm_), total, comm_);
      const int first = slice_.elements() + slice_.rangeOf(total).first;
      slice_.firstElements.push_back(slice_.elements() + total);
      for (const Element& element : mine)
      {
        places.push_back({element.id, first + block.elements()});
        block.elementIds.push_back(element.id);
        block.bodyIds.push_back(element.body);
        block.connectivity.insert(block.connectivity.end(), element.nodes.begin(),
                                  element.nodes.begin() + corners);
      }
    }
    const auto idOf = [](const Place& place) { return place.id; };
    const KeyRanges ranges(places, idOf, comm_);
    const std::vector<Place> sorted = sortOverRanks(places, idOf, ranges, comm_);
    const auto twice = std::adjacent_find(
        sorted.begin(), sorted.end(), [](const Place& a, const Place& b) { return a.id == b.id; });
    if (const std::int64_t id =
            comm_.min(twice == sorted.end() ? INT64_MAX : std::int64_t(twice->id));
        id < INT64_MAX)
      failOnAllRanks(ExitCode::Mesh,
                     "{}: element {} is in two of its parts; an element belongs to one. Split the "
                     "mesh again.",
                     file_, id);
    elements_.emplace(places, comm_);
  }

  void mergeNodeSets()
  {
    for (Mesh::NodeSet& set : slice_.mine.nodeSets)
    {
      std::vector<int> all;
      for (std::size_t p = 0; p < parts_.size(); ++p)
        if (const Mesh::NodeSet* one = withId(parts_[p].nodeSets, set.id))
          for (const int node : one->nodes)
            all.push_back(position(p, node));
      const auto itself = [](int node) { return node; };
      std::vector<int> nodes = sortOverRanks(all, itself, KeyRanges(all, itself, comm_), comm_);
      nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
      slice_.nodeSetSizes.push_back(0);
      set.nodes = inRanges(nodes, slice_.nodeSetSizes.back(), comm_);
    }
  }

  void mergeSideSets()
  {
    constexpr int maxSides = 8;
    std::vector<std::vector<GlobalId>> idsOf; // of each part, in the order of its blocks
    for (const Mesh& part : parts_)
    {
      idsOf.emplace_back();
      for (const Mesh::Block& block : part.blocks)
        idsOf.back().insert(idsOf.back().end(), block.elementIds.begin(), block.elementIds.end());
    }
    for (Mesh::SideSet& set : slice_.mine.sideSets)
    {
      std::vector<GlobalId> ids;
      std::vector<int> sides;
      for (std::size_t p = 0; p < parts_.size(); ++p)
        if (const Mesh::SideSet* one = withId(parts_[p].sideSets, set.id))
          for (std::size_t i = 0; i < one->elements.size(); ++i)
          {
            ids.push_back(idsOf[p].at(one->elements[i]));
            sides.push_back(one->sides[i]);
          }
      std::vector<std::int64_t> all;
      for (const int element : elements_->positions(ids))
        all.push_back(std::int64_t(element) * maxSides + sides[all.size()]);
      const auto itself = [](std::int64_t side) { return side; };
      slice_.sideSetSizes.push_back(0);
      for (const std::int64_t side :
           inRanges(sortOverRanks(all, itself, KeyRanges(all, itself, comm_), comm_),
                    slice_.sideSetSizes.back(), comm_))
      {
        set.elements.push_back(int(side / maxSides));
        set.sides.push_back(int(side % maxSides));
      }
    }
  }

  const std::vector<Mesh>& parts_;
  const std::string& file_;
  const Comm& comm_;
  MeshSlice slice_;
  std::vector<Entity> entities_;
  GlobalId twoShapes_ = 0;      ///< a block with elements of two shapes
  std::vector<int> positions_;  ///< of the nodes of all parts
  std::vector<int> firstNodes_; ///< of each part in positions_
  std::optional<Directory> elements_;
};
} // namespace

std::vector<std::string> partsOfMesh(const std::string& file)
{
  namespace fs = std::filesystem;
  const fs::path folder = folderOf(file);
  const std::string start = fs::path(file).filename().string() + ".";
  std::map<int, std::map<int, std::string>> splits; // by number of parts: part -> name
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory)
    fail(ExitCode::Mesh,
         "{}: the mesh does not exist, and the folder '{}' cannot be read for its parts: {}.", file,
         folder.string(), error.message());
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
  {
    const std::string name = entry->path().filename().string();
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

MeshSlice mergedParts(const std::vector<Mesh>& parts, const std::vector<GlobalId>& blockOrder,
                      const std::string& file, const Comm& comm)
{
  return Merger(parts, blockOrder, file, comm).merge();
}

namespace
{
void demandUnique(const std::string& file, const char* what, const std::vector<GlobalId>& ids,
                  const Comm& comm)
{
  const auto itself = [](GlobalId id) { return id; };
  const KeyRanges ranges(ids, itself, comm);
  if (ranges.lowest() < 1)
    failOnAllRanks(ExitCode::Mesh,
                   "{}: {} id {} is not positive. Renumber the mesh with ids from 1.", file, what,
                   ranges.lowest());
  const std::vector<GlobalId> sorted = sortOverRanks(ids, itself, ranges, comm);
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (const std::int64_t id = comm.min(twice == sorted.end() ? INT64_MAX : std::int64_t(*twice));
      id < INT64_MAX)
    failOnAllRanks(ExitCode::Mesh,
                   "{}: {} id {} occurs more than once; ids must be unique. Renumber the mesh.",
                   file, what, id);
}
} // namespace

void demandUniqueIds(const std::string& file, const MeshSlice& slice, const Comm& comm)
{
  demandUnique(file, "node", slice.mine.nodeIds, comm);
  std::vector<GlobalId> elements;
  for (const Mesh::Block& block : slice.mine.blocks)
    elements.insert(elements.end(), block.elementIds.begin(), block.elementIds.end());
  demandUnique(file, "element", elements, comm);
}
} // namespace coplane
