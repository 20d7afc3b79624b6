#include "CompasFile.hpp"

#include <coplane_core/Error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>

namespace coplane
{
namespace
{
using Json = nlohmann::ordered_json;

/// A turn and a shift, as rows of x y z 1.
using Placement = std::array<std::array<Real, 4>, 3>;
constexpr Placement inPlace{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

Vec3 placed(const Placement& m, const Vec3& x)
{
  const auto row = [&](int i) { return m[i][0] * x.x + m[i][1] * x.y + m[i][2] * x.z + m[i][3]; };
  return {row(0), row(1), row(2)};
}

class CompasReader
{
public:
  explicit CompasReader(const std::string& file) : file_(file) {}

  std::vector<Polyhedron> read()
  {
    std::ifstream stream(file_);
    if (!stream)
      fail(ExitCode::Mesh, "{}: cannot be opened; accepted: a file beside the recipe.", file_);
    Json whole;
    try
    {
      whole = Json::parse(stream);
      find(whole);
    }
    catch (const Json::parse_error& error)
    {
      fail(ExitCode::Mesh, "{}: is no JSON: {}", file_, error.what());
    }
    catch (const Json::exception& error)
    {
      fail(ExitCode::Mesh, "{}: is not as assemblies of COMPAS are written: {}", file_,
           error.what());
    }
    if (solids_.empty())
      fail(ExitCode::Mesh,
           "{}: no blocks were found; accepted: an assembly of compas_assembly or a BlockModel of "
           "compas_dem, as their to_json or json_dump write them (`blocks`, `graph` or "
           "`elements` with meshes of `vertex` and `face`).",
           file_);
    return std::move(solids_);
  }

private:
  static const Json* member(const Json& of, const char* key)
  {
    const auto place = of.is_object() ? of.find(key) : of.end();
    return of.is_object() && place != of.end() && !place->is_null() ? &*place : nullptr;
  }
  /// What a wrapper {dtype, data} holds.
  static const Json& contentOf(const Json& item)
  {
    const Json* const data = member(item, "data");
    return data && member(item, "dtype") ? *data : item;
  }
  static bool isSupport(const Json& item)
  {
    const Json* const flag = member(item, "is_support");
    return flag && flag->is_boolean() && flag->get<bool>();
  }

  void find(const Json& whole)
  {
    if (const Json* const blocks = member(whole, "blocks"); blocks && blocks->is_object())
      return addFirstLayout(whole, *blocks);
    const Json& content = contentOf(whole);
    if (const Json* const graph = member(content, "graph"))
      if (const Json* const nodes = member(contentOf(*graph), "node"))
        for (const auto& [key, node] : nodes->items())
          if (const Json* const block = member(node, "block"))
            addBlock(key, contentOf(*block), isSupport(node), inPlace);
    if (const Json* const elements = member(content, "elements");
        elements && (elements->is_object() || elements->is_array()))
    {
      refusePlacement(content);
      int number = 0;
      for (const auto& [key, element] : elements->items())
      {
        const Json& data = contentOf(element);
        if (const Json* const geometry = member(data, "geometry"))
          addBlock(std::to_string(number), contentOf(*geometry), isSupport(data),
                   placementOf(data, key));
        ++number;
      }
    }
  }

  void addFirstLayout(const Json& whole, const Json& blocks)
  {
    const Json* const assembly = member(whole, "assembly");
    const Json* nodes = assembly ? member(*assembly, "node") : nullptr;
    if (!nodes && assembly)
      nodes = member(*assembly, "vertex");
    for (const auto& [key, block] : blocks.items())
    {
      const Json* const node = nodes ? member(*nodes, key.c_str()) : nullptr;
      addBlock(key, contentOf(block), node && isSupport(*node), inPlace);
    }
  }

  void refusePlacement(const Json& model) const
  {
    if (member(model, "transformation"))
      fail(ExitCode::Mesh,
           "{}: the model as a whole has a transformation, which is not read; accepted: models in "
           "place, whose blocks alone may have one.",
           file_);
  }

  Placement placementOf(const Json& data, const std::string& key) const
  {
    const Json* const transformation = member(data, "transformation");
    if (!transformation)
      return inPlace;
    const Json* const matrix = member(contentOf(*transformation), "matrix");
    if (!matrix || matrix->size() != 4 || (*matrix)[0].size() != 4)
      fail(ExitCode::Mesh,
           "{}: the transformation of block '{}' has no 4 x 4 matrix; accepted: {{\"data\": "
           "{{\"matrix\": [[...], ...]}}}}, or null.",
           file_, key);
    Placement m;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 4; ++j)
        m[i][j] = (*matrix)[i].at(j).get<Real>();
    return m;
  }

  void addBlock(const std::string& name, const Json& mesh, bool support, const Placement& placement)
  {
    const Json *const vertices = member(mesh, "vertex"), *const faces = member(mesh, "face");
    if (!vertices || !faces || !vertices->is_object() || !faces->is_object())
      fail(ExitCode::Mesh,
           "{}: block '{}' has no mesh of `vertex` and `face`; accepted: blocks as meshes, not as "
           "breps.",
           file_, name);
    const Json* usual = member(mesh, "default_vertex_attributes");
    if (!usual)
      usual = member(mesh, "dva");
    Polyhedron solid;
    solid.name = name;
    solid.support = support;
    std::map<std::string, int> numbers;
    for (const auto& [key, vertex] : vertices->items())
    {
      const auto coordinate = [&](const char* axis) -> Real
      {
        const Json* value = member(vertex, axis);
        if (!value && usual)
          value = member(*usual, axis);
        return value ? value->get<Real>() : 0;
      };
      numbers[key] = int(solid.points.size());
      solid.points.push_back(
          placed(placement, {coordinate("x"), coordinate("y"), coordinate("z")}));
    }
    for (const auto& [key, face] : faces->items())
      solid.faces.push_back(cornersOf(face, numbers, name));
    cutWhereNotPlane(solid);
    demandClosed(solid, file_);
    solids_.push_back(std::move(solid));
  }

  /// Keys of vertices are numbers or, in older files, texts.
  std::vector<int> cornersOf(const Json& face, const std::map<std::string, int>& numbers,
                             const std::string& block) const
  {
    std::vector<int> corners;
    for (const Json& corner : face)
    {
      const std::string key =
          corner.is_string() ? corner.get<std::string>() : std::to_string(corner.get<long>());
      const auto number = numbers.find(key);
      if (number == numbers.end())
        fail(ExitCode::Mesh,
             "{}: a face of block '{}' has the vertex {}, which the block does not have.", file_,
             block, key);
      corners.push_back(number->second);
    }
    if (corners.size() < 3)
      fail(ExitCode::Mesh, "{}: a face of block '{}' has {} corners; accepted: 3 or more.", file_,
           block, corners.size());
    return corners;
  }

  static void cutWhereNotPlane(Polyhedron& solid)
  {
    if (isPlane(solid))
      return;
    const auto comesBefore = [&](int a, int b)
    {
      const Vec3 &p = solid.points[std::size_t(a)], &q = solid.points[std::size_t(b)];
      return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    std::vector<std::vector<int>> triangles;
    for (std::vector<int> face : solid.faces)
    {
      std::rotate(face.begin(), std::min_element(face.begin(), face.end(), comesBefore),
                  face.end());
      for (std::size_t k = 1; k + 1 < face.size(); ++k)
        triangles.push_back({face[0], face[k], face[k + 1]});
    }
    solid.faces = std::move(triangles);
  }

  const std::string& file_;
  std::vector<Polyhedron> solids_;
};
} // namespace

std::vector<Polyhedron> readCompasBlocks(const std::string& file)
{
  return CompasReader(file).read();
}
} // namespace coplane
