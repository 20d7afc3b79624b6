#include "SolidFile.hpp"

#include "CompasFile.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>

namespace coplane
{
namespace
{
/// Points that are one, to the last bit of the single precision that files have.
Polyhedron polyhedronOf(const aiMesh& mesh, const std::string& name)
{
  Polyhedron solid;
  solid.name = name;
  std::map<std::array<float, 3>, int> places;
  std::vector<int> numbers;
  for (unsigned v = 0; v < mesh.mNumVertices; ++v)
  {
    const aiVector3D& x = mesh.mVertices[v];
    const auto [place, isNew] = places.insert({{x.x, x.y, x.z}, int(solid.points.size())});
    if (isNew)
      solid.points.push_back({x.x, x.y, x.z});
    numbers.push_back(place->second);
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f)
  {
    const aiFace& face = mesh.mFaces[f];
    std::vector<int> corners;
    for (unsigned k = 0; k < face.mNumIndices; ++k)
    {
      const int number = numbers[face.mIndices[k]];
      if (corners.empty() || (corners.back() != number && corners.front() != number))
        corners.push_back(number);
    }
    if (corners.size() >= 3)
      solid.faces.push_back(corners);
  }
  return solid;
}

/// The shells of a surface: faces that hang together through points.
std::vector<Polyhedron> shellsOf(const Polyhedron& whole)
{
  std::vector<int> leader(whole.points.size());
  std::iota(leader.begin(), leader.end(), 0);
  const auto leaderOf = [&](int point)
  {
    while (leader[std::size_t(point)] != point)
      point = leader[std::size_t(point)] = leader[std::size_t(leader[std::size_t(point)])];
    return point;
  };
  for (const std::vector<int>& face : whole.faces)
    for (const int point : face)
      leader[std::size_t(leaderOf(point))] = leaderOf(face[0]);
  std::map<int, std::size_t> shellOf;
  std::vector<Polyhedron> shells;
  std::vector<int> numbers(whole.points.size(), -1);
  for (const std::vector<int>& face : whole.faces)
  {
    const auto [place, isNew] = shellOf.insert({leaderOf(face[0]), shells.size()});
    if (isNew)
      shells.push_back({whole.name, {}, {}, {}});
    Polyhedron& shell = shells[place->second];
    std::vector<int>& corners = shell.faces.emplace_back();
    for (const int point : face)
    {
      int& number = numbers[std::size_t(point)];
      if (number < 0)
      {
        number = int(shell.points.size());
        shell.points.push_back(whole.points[std::size_t(point)]);
      }
      corners.push_back(number);
    }
  }
  return shells;
}

/// Whether a ray from the point leaves the shell an odd number of times.
bool isInside(const Vec3& point, const Polyhedron& shell)
{
  const Vec3 ray{0.5773, 0.2236, 0.7853}; // along no axis or diagonal
  bool inside = false;
  for (const std::vector<int>& face : shell.faces)
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
    {
      const Vec3& a = shell.points[std::size_t(face[0])];
      const Vec3 u = shell.points[std::size_t(face[k])] - a,
                 v = shell.points[std::size_t(face[k + 1])] - a, w = point - a;
      const Real volume = dot(cross(u, v), ray);
      if (volume == 0)
        continue;
      const Real s = dot(cross(w, v), ray) / volume, t = dot(cross(u, w), ray) / volume;
      inside ^= s >= 0 && t >= 0 && s + t < 1 && dot(cross(u, v), w) / volume < 0;
    }
  return inside;
}

/// Shells inside an odd number of others are cavities of the innermost of them.
std::vector<Polyhedron> solidsOf(const std::vector<Polyhedron>& shells)
{
  const std::size_t count = shells.size();
  std::vector<std::vector<std::size_t>> around(count);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b)
      if (a != b && std::all_of(shells[a].points.begin(), shells[a].points.end(),
                                [&](const Vec3& x) { return isInside(x, shells[b]); }))
        around[a].push_back(b);
  std::vector<Polyhedron> solids;
  std::map<std::size_t, std::size_t> solidOf;
  for (std::size_t a = 0; a < count; ++a)
    if (around[a].size() % 2 == 0)
    {
      solidOf[a] = solids.size();
      solids.push_back(shells[a]);
    }
  for (std::size_t a = 0; a < count; ++a)
    if (around[a].size() % 2 == 1)
      for (const std::size_t b : around[a])
        if (around[b].size() + 1 == around[a].size())
          solids[solidOf.at(b)].cavities.push_back(shells[a]);
  return solids;
}

constexpr char blank = '\x1f'; // stands for one in names

/// An OBJ file whose names of groups and objects have no blanks: Assimp would cut them there, and
/// take groups for one whose names begin alike.
std::string withWholeNames(const std::string& file)
{
  std::ifstream in(file, std::ios::binary);
  std::string text;
  for (std::string line; std::getline(in, line); text += line + '\n')
  {
    const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    const auto key = std::find_if_not(line.begin(), line.end(), isBlank);
    if (line.end() - key < 2 || (*key != 'g' && *key != 'o') || !isBlank(key[1]))
      continue;
    const auto name = std::find_if_not(key + 1, line.end(), isBlank);
    while (line.end() > name && isBlank(line.back()))
      line.pop_back();
    std::replace_if(name, line.end(), isBlank, blank);
  }
  return text;
}

std::vector<Polyhedron> surfacesOf(const aiScene& scene)
{
  std::vector<Polyhedron> surfaces;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m)
  {
    std::string name = scene.mMeshes[m]->mName.C_Str();
    std::replace(name.begin(), name.end(), blank, ' ');
    surfaces.push_back(
        polyhedronOf(*scene.mMeshes[m], name.empty() ? fmt::format("solid {}", m + 1) : name));
  }
  return surfaces;
}
} // namespace

std::vector<Polyhedron> readSolids(const std::string& file)
{
  if (std::filesystem::path(file).extension() == ".json")
    return readCompasBlocks(file);
  Assimp::Importer importer;
  // Points and lines have no inside.
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  const aiScene* scene = nullptr;
  if (extension == ".obj" && std::filesystem::is_regular_file(file))
  {
    const std::string text = withWholeNames(file);
    scene = importer.ReadFileFromMemory(text.data(), text.size(), aiProcess_SortByPType, "obj");
  }
  else
    scene = importer.ReadFile(file, aiProcess_SortByPType);
  if (!scene || scene->mNumMeshes == 0)
    fail(ExitCode::Mesh, "{}: no surfaces of solids can be read: {}", file,
         scene ? "it has no faces" : importer.GetErrorString());
  std::vector<Polyhedron> surfaces = surfacesOf(*scene);
  if (!std::all_of(surfaces.begin(), surfaces.end(), isPlane))
    surfaces = surfacesOf(*importer.ApplyPostProcessing(aiProcess_Triangulate));
  std::map<std::string, int> bearers;
  for (const Polyhedron& surface : surfaces)
    ++bearers[surface.name];
  for (std::size_t k = 0; k < surfaces.size(); ++k)
    if (bearers.at(surfaces[k].name) > 1)
      surfaces[k].name = fmt::format("{}, solid {}", surfaces[k].name, k + 1);
  std::vector<Polyhedron> solids;
  for (const Polyhedron& surface : surfaces)
  {
    demandClosed(surface, file);
    const std::vector<Polyhedron> parts = solidsOf(shellsOf(surface));
    for (std::size_t k = 0; k < parts.size(); ++k)
    {
      solids.push_back(parts[k]);
      if (parts.size() > 1)
        solids.back().name = fmt::format("{}, part {}", surface.name, k + 1);
    }
  }
  return solids;
}
} // namespace coplane
