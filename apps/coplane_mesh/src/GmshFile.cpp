#include "GmshFile.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <unordered_map>

namespace coplane
{
namespace
{
constexpr const char* howToExport = "Save it as version 4.1: gmsh model.geo -3 -format msh41 (two "
                                    "dimensions: -2), or File > Export "
                                    "with 'Version 4 ASCII'.";

/// Words and numbers of a file; in binary sections numbers are bytes.
class Tokens
{
public:
  Tokens(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}

  void setBinary(bool binary) { binary_ = binary; }
  bool binary() const { return binary_; }

  /// The next word; empty at the end of the file.
  std::string word()
  {
    skipSpace();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !isSpace(text_[at_]))
      ++at_;
    return text_.substr(begin, at_ - begin);
  }

  int wordInt(const char* what) { return int(parseInteger(word(), what)); }
  Real wordReal(const char* what)
  {
    const std::string text = word();
    char* end = nullptr;
    const Real value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0')
      refuse(fmt::format("'{}' is found for {}, which is a number", text, what));
    return value;
  }
  /// Text between quotation marks.
  std::string quoted(const char* what)
  {
    skipSpace();
    if (at_ >= text_.size() || text_[at_] != '"')
      refuse(fmt::format("{} must stand between quotation marks", what));
    const std::size_t end = text_.find('"', at_ + 1);
    if (end == std::string::npos)
      refuse(fmt::format("the quotation mark that ends {} is missing", what));
    const std::string name = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return name;
  }

  int integer(const char* what) { return binary_ ? raw<int>(what) : wordInt(what); }
  GlobalId size(const char* what)
  {
    const GlobalId value =
        binary_ ? GlobalId(raw<std::uint64_t>(what)) : parseInteger(word(), what);
    if (value < 0)
      refuse(fmt::format("{} is {}", what, value));
    return value;
  }
  /// A number of things that follow; more than bytes in the file means a damaged file.
  GlobalId count(const char* what)
  {
    const GlobalId value = size(what);
    if (value > GlobalId(text_.size()))
      refuse(fmt::format("{} is {}, more than the file can hold", what, value));
    return value;
  }
  Real real(const char* what) { return binary_ ? raw<Real>(what) : wordReal(what); }
  template <class T>
  T raw(const char* what)
  {
    T value;
    if (text_.size() - at_ < sizeof value)
      refuse(fmt::format("the file ends before {}", what));
    std::memcpy(&value, text_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  /// In binary files one line end stands between the name of a section and its bytes.
  void toBytes()
  {
    const std::size_t end = text_.find('\n', at_);
    at_ = end == std::string::npos ? text_.size() : end + 1;
  }
  void skipPast(const std::string& mark)
  {
    const std::size_t found = text_.find(mark, at_);
    if (found == std::string::npos)
      refuse(fmt::format("{} is missing", mark));
    at_ = found + mark.size();
  }

  [[noreturn]] void refuse(const std::string& what) const
  {
    const std::size_t end = std::min(at_, text_.size());
    const std::string place =
        binary_ ? fmt::format("byte {}", end)
                : fmt::format("{}", 1 + std::count(text_.begin(),
                                                   text_.begin() + std::ptrdiff_t(end), '\n'));
    fail(ExitCode::Mesh, "{}:{}: {}. The file is damaged or no Gmsh mesh; save it again.", file_,
         place, what);
  }
  const std::string& file() const { return file_; }

private:
  static bool isSpace(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
  void skipSpace()
  {
    while (at_ < text_.size() && isSpace(text_[at_]))
      ++at_;
  }
  GlobalId parseInteger(const std::string& text, const char* what) const
  {
    char* end = nullptr;
    const long long value = std::strtoll(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0')
      refuse(fmt::format("'{}' is found for {}, which is a whole number", text, what));
    return value;
  }

  std::string file_, text_;
  std::size_t at_ = 0;
  bool binary_ = false;
};

class GmshReader
{
public:
  explicit GmshReader(Tokens tokens) : tokens_(std::move(tokens)) {}

  GmshFile read()
  {
    readFormat();
    for (std::string section = tokens_.word(); !section.empty(); section = tokens_.word())
    {
      if (section.front() != '$')
        tokens_.refuse(fmt::format("'{}' is found where a section ($Nodes, ...) must begin",
                                   section.substr(0, 40)));
      const std::string name = section.substr(1);
      if (name == "PartitionedEntities")
        fail(ExitCode::Mesh,
             "{}: the mesh is partitioned, which Coplane does itself. Save it without partitions.",
             tokens_.file());
      if (name == "PhysicalNames")
        readPhysicalNames();
      else if (name == "Entities")
        readEntities();
      else if (name == "Nodes")
        readNodes();
      else if (name == "Elements")
        readElements();
      tokens_.skipPast("$End" + name);
    }
    if (!hasElements_)
      tokens_.refuse("$Elements is missing");
    return std::move(model_);
  }

private:
  void readFormat()
  {
    if (tokens_.word() != "$MeshFormat")
      fail(ExitCode::Mesh,
           "{}: the file does not begin with $MeshFormat: it is no mesh of Gmsh, or older than "
           "version 2. {}",
           tokens_.file(), howToExport);
    const std::string version = tokens_.word();
    if (version != "4.1")
      fail(ExitCode::Mesh, "{}: the format is version {}; 4.1 is accepted. {}", tokens_.file(),
           version, howToExport);
    const bool binary = tokens_.wordInt("the kind of file") == 1;
    if (tokens_.wordInt("the size of numbers") != 8)
      tokens_.refuse("the size of numbers is not 8");
    tokens_.setBinary(binary);
    if (binary)
    {
      tokens_.toBytes();
      if (tokens_.raw<int>("the test of the byte order") != 1)
        fail(ExitCode::Mesh,
             "{}: the numbers of this binary file have the byte order of another kind of machine. "
             "Save it as text.",
             tokens_.file());
    }
    tokens_.skipPast("$EndMeshFormat");
  }

  void readPhysicalNames()
  {
    const bool binary = tokens_.binary();
    tokens_.setBinary(false); // names are text in every file
    const GlobalId count = tokens_.count("the number of names");
    for (GlobalId i = 0; i < count; ++i)
    {
      const int dimension = tokens_.wordInt("the dimension of a group");
      const int tag = tokens_.wordInt("the number of a group");
      model_.physicalNames[{dimension, tag}] = tokens_.quoted("the name of a group");
    }
    tokens_.setBinary(binary);
  }

  void begin()
  {
    if (tokens_.binary())
      tokens_.toBytes();
  }

  /// Of a group of an entity; negative where the entity is turned round.
  int groupNumber()
  {
    const int group = tokens_.integer("a group of an entity");
    if (group == std::numeric_limits<int>::min())
      tokens_.refuse(fmt::format("a group of an entity is {}", group));
    return std::abs(group);
  }

  void readEntities()
  {
    begin();
    GlobalId counts[4];
    for (GlobalId& count : counts)
      count = tokens_.count("a number of entities");
    for (int dimension = 0; dimension < 4; ++dimension)
      for (GlobalId i = 0; i < counts[dimension]; ++i)
      {
        const int tag = tokens_.integer("the number of an entity");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k)
          tokens_.real("the bounding box of an entity");
        std::vector<int>& groups = model_.physicalsOfEntity[{dimension, tag}];
        const GlobalId physicals = tokens_.count("the number of an entity's groups");
        for (GlobalId k = 0; k < physicals; ++k)
          groups.push_back(groupNumber());
        const GlobalId bounding = dimension > 0 ? tokens_.count("the size of a boundary") : 0;
        for (GlobalId k = 0; k < bounding; ++k)
          tokens_.integer("an entity of a boundary");
      }
  }

  void readNodes()
  {
    begin();
    const GlobalId blocks = tokens_.count("the number of blocks of nodes");
    tokens_.size("the number of nodes");
    tokens_.size("the least number of a node");
    tokens_.size("the largest number of a node");
    for (GlobalId b = 0; b < blocks; ++b)
    {
      const int dimension = tokens_.integer("the dimension of an entity");
      tokens_.integer("the number of an entity");
      const bool parametric = tokens_.integer("whether nodes have parameters") != 0;
      const GlobalId count = tokens_.count("the number of nodes of an entity");
      for (GlobalId i = 0; i < count; ++i)
      {
        const GlobalId id = tokens_.size("the number of a node");
        if (!nodeOfId_.emplace(id, int(model_.nodeIds.size())).second)
          tokens_.refuse(fmt::format("node {} occurs twice", id));
        model_.nodeIds.push_back(id);
      }
      for (GlobalId i = 0; i < count; ++i)
      {
        const Real x = tokens_.real("a coordinate"), y = tokens_.real("a coordinate"),
                   z = tokens_.real("a coordinate");
        model_.coordinates.push_back({x, y, z});
        for (int k = 0; parametric && k < dimension; ++k)
          tokens_.real("a parameter of a node");
      }
    }
  }

  void readElements()
  {
    begin();
    hasElements_ = true;
    const GlobalId blocks = tokens_.count("the number of blocks of elements");
    tokens_.size("the number of elements");
    tokens_.size("the least number of an element");
    tokens_.size("the largest number of an element");
    for (GlobalId b = 0; b < blocks; ++b)
    {
      const int dimension = tokens_.integer("the dimension of an entity");
      const int tag = tokens_.integer("the number of an entity");
      const int type = tokens_.integer("the type of elements");
      const GlobalId count = tokens_.count("the number of elements of an entity");
      const int nodes = nodesOfGmshType(type);
      if (nodes == 0)
        refuseType(type, dimension, tag);
      if (const int own = type == 15 ? 0 : type == 1 ? 1 : type <= 3 ? 2 : 3; own != dimension)
        tokens_.refuse(fmt::format("elements of Gmsh's type {} have dimension {}, their entity {}",
                                   type, own, dimension));
      for (GlobalId i = 0; i < count; ++i)
      {
        GmshFile::Element element{
            {dimension, tag}, type, tokens_.size("the number of an element"), {}};
        for (int k = 0; k < nodes; ++k)
        {
          const GlobalId id = tokens_.size("a node of an element");
          const auto node = nodeOfId_.find(id);
          if (node == nodeOfId_.end())
            tokens_.refuse(fmt::format("element {} uses node {}, which the file does not have",
                                       element.id, id));
          element.nodes[k] = node->second;
        }
        model_.elements.push_back(element);
      }
    }
  }

  [[noreturn]] void refuseType(int type, int dimension, int tag) const
  {
    const char* kinds[] = {"point", "curve", "surface", "volume"};
    const std::string where =
        fmt::format("{}: {} {}", tokens_.file(),
                    dimension >= 0 && dimension < 4 ? kinds[dimension] : "entity", tag);
    if (type == 6 || type == 7)
      fail(ExitCode::Mesh,
           "{} has {}; triangles, quadrilaterals, tetrahedra and hexahedra are accepted. Mesh it "
           "with tetrahedra, or with hexahedra only.",
           where, type == 6 ? "prisms" : "pyramids");
    fail(ExitCode::Mesh,
         "{} has elements of Gmsh's type {}, of order two or higher; order one is accepted. Set "
         "Mesh.ElementOrder = 1 and mesh again.",
         where, type);
  }

  Tokens tokens_;
  GmshFile model_;
  std::unordered_map<GlobalId, int> nodeOfId_;
  bool hasElements_ = false;
};
} // namespace

int nodesOfGmshType(int type)
{
  static const std::map<int, int> nodes{{15, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 4}, {5, 8}};
  const auto found = nodes.find(type);
  return found == nodes.end() ? 0 : found->second;
}

GmshFile readGmshFile(const std::string& name)
{
  if (const std::string kind = kindOfSpecialFile(name); !kind.empty())
    fail(ExitCode::Mesh, "{}: this is {}; accepted: a file of Gmsh.", name, kind);
  std::ifstream file(name, std::ios::binary);
  std::stringstream text;
  if (!file || !(text << file.rdbuf()))
    fail(ExitCode::Mesh, "{}: the mesh cannot be read. Check its name and its permissions.", name);
  return GmshReader(Tokens(name, text.str())).read();
}
} // namespace coplane
