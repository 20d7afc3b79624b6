#include "SolidFile.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <map>

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

void demandClosed(const Polyhedron& solid, const std::string& file)
{
  std::map<std::pair<int, int>, int> facesOfEdge;
  for (const std::vector<int>& face : solid.faces)
    for (std::size_t k = 0; k < face.size(); ++k)
      ++facesOfEdge[std::minmax(face[k], face[(k + 1) % face.size()])];
  for (const auto& [edge, count] : facesOfEdge)
    if (count != 2)
    {
      const Vec3 &a = solid.points[std::size_t(edge.first)],
                 &b = solid.points[std::size_t(edge.second)];
      fail(ExitCode::Mesh,
           "{}: the surface of '{}' is not closed: the edge from ({}, {}, {}) to ({}, {}, {}) m "
           "belongs to {} face{}, and two were expected. Mend the surface, for instance by "
           "merging points that lie on each other.",
           file, solid.name, a.x, a.y, a.z, b.x, b.y, b.z, count, count == 1 ? "" : "s");
    }
}
} // namespace

std::vector<Polyhedron> readSolids(const std::string& file)
{
  Assimp::Importer importer;
  // Points and lines have no inside.
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* const scene = importer.ReadFile(file, aiProcess_SortByPType);
  if (!scene || scene->mNumMeshes == 0)
    fail(ExitCode::Mesh, "{}: no surfaces of solids can be read: {}", file,
         scene ? "it has no faces" : importer.GetErrorString());
  std::vector<Polyhedron> solids;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m)
  {
    const std::string name = scene->mMeshes[m]->mName.C_Str();
    solids.push_back(
        polyhedronOf(*scene->mMeshes[m], name.empty() ? fmt::format("solid {}", m + 1) : name));
    demandClosed(solids.back(), file);
  }
  return solids;
}
} // namespace coplane
