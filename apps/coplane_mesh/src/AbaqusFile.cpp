#include "AbaqusFile.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/DeckNode.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

namespace coplane
{
namespace
{
std::string upper(std::string text)
{
  for (char& c : text)
    c = char(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// What stands between commas, those in quotes not counted; the quotes are taken away.
std::vector<std::string> fieldsOf(const std::string& line)
{
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line)
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  for (std::string& field : fields)
    field = trimmed(field);
  while (!fields.empty() && fields.back().empty())
    fields.pop_back();
  return fields;
}

/// A first-order shape: what Gmsh calls it, and the nodes of its faces S1, S2, ...
struct Shape
{
  int dimension, gmshType, faceType;
  std::vector<std::vector<int>> faces;
};

const Shape* shapeOf(const std::string& type)
{
  static const Shape hex{
      3,
      5,
      3,
      {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};
  static const Shape tet{3, 4, 2, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  static const Shape quad{2, 3, 1, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
  static const Shape triangle{2, 2, 1, {{0, 1}, {1, 2}, {2, 0}}};
  const auto begins = [&](const char* name) { return type.rfind(name, 0) == 0; };
  const bool plane = begins("CPS") || begins("CPE") || begins("CAX");
  const char nodes = plane && type.size() > 3 ? type[3] : ' ';
  const bool alone = type.size() < 5 || !std::isdigit(static_cast<unsigned char>(type[4]));
  if (begins("C3D8"))
    return &hex;
  if (begins("C3D4") && alone)
    return &tet;
  return nodes == '4' && alone ? &quad : nodes == '3' && alone ? &triangle : nullptr;
}

class AbaqusReader
{
public:
  explicit AbaqusReader(const std::string& file) : file_(file) {}

  AbaqusFile read()
  {
    std::stringstream text(readTextFile(file_, {"the file of Abaqus", "", "", infinity}));
    for (std::string line; std::getline(text, line);)
    {
      if (++line_ == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) // a byte order mark
        line.erase(0, 3);
      line = trimmed(line);
      if (line.empty() || line.rfind("**", 0) == 0)
        continue;
      if (line[0] == '*' || continued_)
        takeKeyword(line);
      else
        takeData(fieldsOf(line));
    }
    finishElement();
    return assemble();
  }

private:
  struct Element
  {
    GlobalId id;
    const Shape* shape;
    std::string set;
    std::vector<GlobalId> nodes;
  };
  struct Side
  {
    std::string name; ///< of a set, or the number of an element
    int face;
  };

  template <class... Args>
  [[noreturn]] void refuse(const char* format, const Args&... args) const
  {
    fail(ExitCode::Mesh, "{}:{}: {}", file_, line_, fmt::format(fmt::runtime(format), args...));
  }

  void takeKeyword(const std::string& line)
  {
    if (!continued_)
    {
      finishElement();
      keyword_.clear();
      parameters_.clear();
    }
    const std::vector<std::string> words = fieldsOf(line);
    for (std::size_t w = 0; w < words.size(); ++w)
    {
      if (w == 0 && !continued_)
      {
        keyword_ = upper(words[0]);
        keyword_.erase(std::remove(keyword_.begin(), keyword_.end(), ' '), keyword_.end());
        continue;
      }
      const std::size_t sign = words[w].find('=');
      parameters_[upper(trimmed(words[w].substr(0, sign)))] =
          sign == std::string::npos ? "" : trimmed(words[w].substr(sign + 1));
    }
    continued_ = line.back() == ',';
    if (!continued_)
      beginKeyword();
  }

  /// Names are the same in upper and lower case; the first spelling stays.
  std::string named(const std::string& name)
  {
    return spellings_.insert({upper(name), name}).first->second;
  }

  void beginKeyword()
  {
    for (const char* const key : {"NSET", "ELSET", "NAME"})
      if (const auto given = parameters_.find(key); given != parameters_.end())
        given->second = named(given->second);
    if (keyword_ == "*INCLUDE")
      refuse("*INCLUDE is not followed. Put all of the mesh into one file.");
    // What makes or moves nodes and elements: without it the mesh would be another one.
    for (const char* const maker :
         {"*NGEN", "*NFILL", "*NCOPY", "*NMAP", "*ELGEN", "*ELCOPY", "*SYSTEM"})
      if (keyword_ == maker)
        refuse("{} is not read. Export the mesh with all of its nodes and elements, in global "
               "coordinates.",
               maker);
    if ((keyword_ == "*NODE" || keyword_ == "*ELEMENT" || keyword_ == "*NSET" ||
         keyword_ == "*ELSET") &&
        parameters_.count("INPUT"))
      refuse("INPUT is not followed. Put all of the mesh into one file.");
    if (keyword_ == "*NODE" && parameters_.count("SYSTEM") && upper(parameters_["SYSTEM"]) != "R")
      refuse("nodes in the system {} are not read. Export them in global coordinates.",
             parameters_["SYSTEM"]);
    if (keyword_ == "*INSTANCE" && ++instances_ > 1)
      refuse("a second instance is not read. Export the mesh of the assembly as one part.");
    for (const auto& [set, key] :
         {std::pair{"*NSET", "NSET"}, {"*ELSET", "ELSET"}, {"*SURFACE", "NAME"}})
      if (keyword_ == set && parameters_[key].empty())
        refuse("{} has no name: {}= is missing.", set, key);
    if (keyword_ == "*NSET" && parameters_.count("ELSET"))
      takeNodesOf(parameters_["ELSET"]);
    if (keyword_ == "*NODE")
      nodeSet_ = parameters_["NSET"];
    if (keyword_ == "*ELEMENT")
    {
      const std::string type = upper(parameters_["TYPE"]);
      shape_ = shapeOf(type);
      if (!shape_ && type != "T3D2")
        refuse("elements of type '{}' are not read. Accepted: first-order solids: C3D8, C3D8R, "
               "C3D4; in two dimensions CPE4, CPE3, CPS4, CPS3, CAX4, CAX3.",
               type);
    }
    if (keyword_ == "*SOLIDSECTION")
      sections_.push_back(parameters_["ELSET"]);
    if (keyword_ == "*SURFACE" && parameters_.count("TYPE") &&
        upper(parameters_["TYPE"]) != "ELEMENT" && upper(parameters_["TYPE"]) != "NODE")
      refuse("surfaces of type {} are not read. Accepted: ELEMENT, NODE.", parameters_["TYPE"]);
    if (keyword_ == "*SURFACE")
      surfaces_.insert({parameters_["NAME"], {}});
  }

  GlobalId integer(const std::string& text) const
  {
    char* end = nullptr;
    const long long value = std::strtoll(text.c_str(), &end, 10);
    if (text.empty() || *end != '\0' || value <= 0)
      refuse("'{}' is found for the number of a node or element, which is a whole number above 0.",
             text);
    return value;
  }

  void takeData(const std::vector<std::string>& fields)
  {
    if (keyword_ == "*NODE")
      takeNode(fields);
    else if (keyword_ == "*ELEMENT" && !shape_)
      ++curveElements_;
    else if (keyword_ == "*ELEMENT")
      takeElement(fields);
    else if (keyword_ == "*NSET")
      takeMembers(fields, nodeSets_[parameters_["NSET"]], nodeSets_);
    else if (keyword_ == "*ELSET")
      takeMembers(fields, elementSets_[parameters_["ELSET"]], elementSets_);
    else if (keyword_ == "*SURFACE")
      takeSide(fields);
    else if (keyword_ == "*INSTANCE")
      refuse("instances that are moved are not read. Export the mesh of the assembly as one part.");
    else if (keyword_.empty())
      refuse("the file does not begin with a keyword such as *NODE: it is no file of Abaqus or "
             "CalculiX.");
  }

  void takeNode(const std::vector<std::string>& fields)
  {
    if (fields.empty() || fields.size() > 7)
      refuse("a node has its number, 3 coordinates and, for shells, a normal; here are {} values.",
             fields.size());
    Vec3 place{}; // what is not given is zero
    for (std::size_t axis = 0; axis < 3 && axis + 1 < fields.size(); ++axis)
    {
      std::string field = upper(fields[axis + 1]);
      std::replace(field.begin(), field.end(), 'D', 'E'); // 1.5D3 of Fortran
      if (field.empty())
        continue;
      char* end = nullptr;
      place[int(axis)] = std::strtod(field.c_str(), &end);
      if (*end != '\0' || !std::isfinite(place[int(axis)]))
        refuse("'{}' is found for a coordinate, which is a number.", fields[axis + 1]);
    }
    const GlobalId id = integer(fields[0]);
    if (!nodes_.insert({id, place}).second)
      refuse("node {} is given twice. Several parts with numbers of their own are not read: export "
             "the mesh of the assembly as one part.",
             id);
    if (!nodeSet_.empty())
      nodeSets_[nodeSet_].insert(id);
  }

  /// Elements may go on in the next line.
  void takeElement(const std::vector<std::string>& fields)
  {
    std::size_t next = 0;
    if (!unfinished_)
    {
      elements_.push_back({integer(fields[next++]), shape_, parameters_["ELSET"], {}});
      unfinished_ = true;
    }
    Element& element = elements_.back();
    const std::size_t count = std::size_t(nodesOfGmshType(shape_->gmshType));
    for (; next < fields.size(); ++next)
      element.nodes.push_back(integer(fields[next]));
    if (element.nodes.size() > count)
      refuse("element {} has {} nodes; its type has {}.", element.id, element.nodes.size(), count);
    if (element.nodes.size() == count)
      finishElement();
  }

  void finishElement()
  {
    if (!unfinished_)
      return;
    unfinished_ = false;
    const Element& element = elements_.back();
    const std::size_t count = std::size_t(nodesOfGmshType(element.shape->gmshType));
    if (element.nodes.size() != count)
      refuse("element {} has {} nodes; its type has {}.", element.id, element.nodes.size(), count);
    if (!element.set.empty())
      elementSets_[element.set].insert(element.id);
  }

  using Sets = std::map<std::string, std::set<GlobalId>>;
  /// The nodes of a set of elements.
  void takeNodesOf(const std::string& elementSet)
  {
    const auto set = elementSets_.find(elementSet);
    if (set == elementSets_.end())
      refuse("ELSET names '{}', and no set of elements of this name stands before.", elementSet);
    std::set<GlobalId>& nodes = nodeSets_[parameters_["NSET"]];
    for (const Element& element : elements_)
      if (set->second.count(element.id))
        nodes.insert(element.nodes.begin(), element.nodes.end());
  }

  /// Without the name of the instance: `P-1.top` is the set `top`, `P-1.7` the number 7.
  static std::string withoutInstance(const std::string& name)
  {
    return name.substr(name.rfind('.') + 1);
  }

  /// @param others sets of the same kind, which may be named instead of numbers
  void takeMembers(const std::vector<std::string>& fields, std::set<GlobalId>& set,
                   const Sets& others)
  {
    if (parameters_.count("GENERATE"))
    {
      if (fields.size() < 2 || fields.size() > 3)
        refuse("GENERATE has lines of the first number, the last and the step; here are {} values.",
               fields.size());
      const GlobalId from = integer(fields[0]), to = integer(fields[1]),
                     step = fields.size() > 2 ? integer(fields[2]) : 1;
      constexpr GlobalId most = 50'000'000;
      if (to < from || (to - from) / step >= most)
        refuse("GENERATE goes from {} to {} by {}; up to {} numbers are read.", from, to, step,
               most);
      for (GlobalId id = from; id <= to; id += step)
        set.insert(id);
      return;
    }
    for (const std::string& field : fields)
    {
      auto other = others.find(named(field));
      const std::string bare = withoutInstance(field);
      if (other == others.end() && bare != field)
        other = others.find(named(bare));
      if (other != others.end())
      {
        const std::set<GlobalId> members = other->second;
        set.insert(members.begin(), members.end());
      }
      else if (bare.find_first_not_of("0123456789-+") != std::string::npos)
        refuse("'{}' is no number, and no set of this name stands before.", field);
      else
        set.insert(integer(bare));
    }
  }

  void takeSide(const std::vector<std::string>& fields)
  {
    if (upper(parameters_["TYPE"]) == "NODE")
    {
      takeMembers({fields.at(0)}, nodeSets_[parameters_["NAME"]], nodeSets_);
      return;
    }
    const std::string face = fields.size() > 1 ? upper(fields[1]) : "";
    const bool isFace = face.size() == 2 && face[0] == 'S' && face[1] >= '1' && face[1] <= '6';
    if (!isFace)
      refuse("a surface is a set or an element and one of its faces, S1 to S6; '{}' is found for "
             "the face.",
             face);
    std::string name = named(fields[0]);
    if (!elementSets_.count(name))
      name = named(withoutInstance(fields[0]));
    surfaces_[parameters_["NAME"]].push_back({name, face[1] - '1'});
  }

  // --- in the terms of Gmsh
  // -----------------------------------------------------------------------

  AbaqusFile assemble()
  {
    if (nodes_.empty() || elements_.empty())
      fail(ExitCode::Mesh, "{}: the file has no {}.", file_, nodes_.empty() ? "nodes" : "elements");
    for (const Element& element : elements_)
      dimension_ = std::max(dimension_, element.shape->dimension);
    for (auto& [id, place] : nodes_)
    {
      if (dimension_ == 2)
        place.z = 0; // which plane elements do not have
      indexOfNode_[id] = int(result_.mesh.nodeIds.size());
      result_.mesh.nodeIds.push_back(id);
      result_.mesh.coordinates.push_back(place);
    }
    addElements();
    addSurfaces();
    for (const auto& [name, members] : nodeSets_)
    {
      // A side set has a node set of its name, which is another one.
      const bool isSurface = surfaces_.count(name) && !surfaces_.at(name).empty();
      if (isSurface)
        result_.notes.push_back(fmt::format(
            "the node set '{0}' has the name of a surface and becomes '{0}_nodes'", name));
      const GmshFile::Tag entity = newGroup(0, isSurface ? name + "_nodes" : name);
      for (const GlobalId node : members)
        addElement(entity, 15, 0, {node});
    }
    return std::move(result_);
  }

  GmshFile::Tag newGroup(int dimension, const std::string& name)
  {
    const int number = ++groups_[dimension];
    result_.mesh.physicalNames[{dimension, number}] = name;
    result_.mesh.physicalsOfEntity[{dimension, number}] = {number};
    return {dimension, number};
  }

  void addElement(const GmshFile::Tag& entity, int type, GlobalId id,
                  const std::vector<GlobalId>& nodes)
  {
    GmshFile::Element element;
    element.entity = entity;
    element.type = type;
    element.id = id;
    for (std::size_t n = 0; n < nodes.size(); ++n)
    {
      const auto found = indexOfNode_.find(nodes[n]);
      if (found == indexOfNode_.end())
        fail(ExitCode::Mesh, "{}: {} names node {}, which the file does not have.", file_,
             id ? fmt::format("element {}", id)
                : fmt::format("the set '{}'", result_.mesh.physicalNames[entity]),
             nodes[n]);
      element.nodes[n] = found->second;
    }
    result_.mesh.elements.push_back(element);
  }

  void addElements()
  {
    std::map<GlobalId, std::string> blockOf;
    for (const std::string& section : sections_)
    {
      const auto set = elementSets_.find(section);
      if (set == elementSets_.end())
        fail(ExitCode::Mesh,
             "{}: *SOLID SECTION names the element set '{}', which the file does "
             "not have.",
             file_, section);
      for (const GlobalId id : set->second)
        blockOf.insert({id, section});
    }
    std::map<std::string, GmshFile::Tag> blocks;
    int left = curveElements_;
    for (const Element& element : elements_)
    {
      if (!elementOf_.insert({element.id, &element}).second)
        fail(ExitCode::Mesh, "{}: element {} is given twice.", file_, element.id);
      const auto section = blockOf.find(element.id);
      std::string name = section != blockOf.end() ? section->second : element.set;
      if (element.shape->dimension < dimension_ || (!sections_.empty() && section == blockOf.end()))
      {
        ++left;
        continue;
      }
      if (name.empty())
        name = "block_1";
      if (!blocks.count(name))
        blocks[name] = newGroup(dimension_, name);
      addElement(blocks[name], element.shape->gmshType, element.id, element.nodes);
    }
    if (left > 0)
      result_.notes.push_back(fmt::format(
          "{} elements are of no section or of a lower dimension and are left out", left));
    std::set<std::string> unused;
    for (const auto& [name, members] : elementSets_)
      if (!blocks.count(name))
        unused.insert(name);
    if (!unused.empty())
      result_.notes.push_back(
          fmt::format("element sets that are no blocks are left out: {}", fmt::join(unused, ", ")));
  }

  void addSurfaces()
  {
    for (const auto& [name, sides] : surfaces_)
    {
      if (sides.empty())
        continue;
      const GmshFile::Tag entity = newGroup(dimension_ - 1, name);
      for (const Side& side : sides)
      {
        const auto set = elementSets_.find(side.name);
        const std::set<GlobalId> alone{
            set == elementSets_.end() ? std::strtoll(side.name.c_str(), nullptr, 10) : 0};
        for (const GlobalId id : set == elementSets_.end() ? alone : set->second)
          addFace(entity, name, id, side);
      }
    }
  }

  void addFace(const GmshFile::Tag& entity, const std::string& surface, GlobalId id,
               const Side& side)
  {
    const auto found = elementOf_.find(id);
    if (found == elementOf_.end())
      fail(ExitCode::Mesh,
           "{}: the surface '{}' names '{}', which is neither a set nor an element.", file_,
           surface, side.name);
    const Element& element = *found->second;
    if (element.shape->dimension < dimension_)
      return; // was left out
    if (side.face >= int(element.shape->faces.size()))
      fail(ExitCode::Mesh, "{}: the surface '{}' names face S{} of element {}, which has {}.",
           file_, surface, side.face + 1, id, element.shape->faces.size());
    std::vector<GlobalId> nodes;
    for (const int n : element.shape->faces[std::size_t(side.face)])
      nodes.push_back(element.nodes[std::size_t(n)]);
    addElement(entity, element.shape->faceType, id, nodes);
  }

  const std::string& file_;
  int line_ = 0;
  std::map<std::string, std::string> spellings_; ///< of names, by the name in upper case
  std::string keyword_;
  std::map<std::string, std::string> parameters_;
  bool continued_ = false;  ///< the keyword goes on in the next line
  bool unfinished_ = false; ///< so does the last element
  int instances_ = 0;
  int curveElements_ = 0; ///< T3D2, as which Gmsh writes the curves of a model; not read
  int dimension_ = 0;     ///< the highest of an element
  std::string nodeSet_;
  const Shape* shape_ = nullptr;
  std::map<GlobalId, Vec3> nodes_;
  std::vector<Element> elements_;
  Sets nodeSets_, elementSets_;
  std::vector<std::string> sections_;
  std::map<std::string, std::vector<Side>> surfaces_;
  std::map<GlobalId, int> indexOfNode_;
  std::map<GlobalId, const Element*> elementOf_;
  std::map<int, int> groups_; ///< by dimension
  AbaqusFile result_;
};
} // namespace

AbaqusFile readAbaqusFile(const std::string& file)
{
  return AbaqusReader(file).read();
}
} // namespace coplane
