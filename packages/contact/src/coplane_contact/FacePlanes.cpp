#include <coplane_contact/HalfStepFace.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_core/BranchFree.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
template <class T>
struct MeanPlane
{
  Vec3Of<T> center{}, normal{};
  T width{}; ///< across the longest edge [m]
  T warp{};
};

template <int Dim, class T>
MeanPlane<T> meanPlane(const FaceNodesOf<T>& nodes)
{
  const HalfStepFaceOf<T> face = stepA_faceAtEnd<Dim>(nodes);
  T warp{};
  if (nodes.count == 4)
    warp = 0.25 *
           branchFree::absolute(dot(face.normal, face.x[0] - face.x[1] + face.x[2] - face.x[3]));
  T longest{};
  for (int i = 0; i < nodes.count; ++i)
  {
    const Vec3Of<T> edge = nodes.x[i + 1 == nodes.count ? 0 : i + 1] - nodes.x[i];
    longest = branchFree::larger(dot(edge, edge), longest);
  }
  const T width =
      Dim == 2 ? face.area
               : (nodes.count == 3 ? 2.0 : 1.0) * face.area / branchFree::squareRoot(longest);
  return {face.center, face.normal, width, warp};
}

/// The nodes of as many faces as T has lanes, where `place(node)` says; their v and masses are not
/// looked up.
template <class T, class Place>
FaceNodesOf<T> nodesAt(const Face* faces, const Place& place)
{
  FaceNodesOf<T> nodes;
  nodes.count = faces[0].count;
  for (int k = 0; k < nodes.count; ++k)
  {
    Vec3 x[branchFree::widthOf<T>];
    for (int i = 0; i < branchFree::widthOf<T>; ++i)
      x[i] = place(faces[i].nodes[k]);
    for (int c = 0; c < 3; ++c)
      nodes.x[k][c] = branchFree::gathered<T>([&](int i) -> Real { return x[i][c]; });
  }
  return nodes;
}

/// CandidateRules::planeOf() of as many faces with the same number of nodes as T has lanes.
template <int Dim, class T>
void putPlanes(const Face* faces, const ConstNodeVectors& x, const CandidateRules& rules,
               FacePlane* planes)
{
  const MeanPlane<T> now = meanPlane<Dim>(nodesAt<T>(faces, [&](int node) { return at(x, node); }));
  T turning{}, warp = now.warp;
  if (rules.turning > 0 && rules.motion.ahead > 0)
  {
    const MeanPlane<T> then = meanPlane<Dim>(
        nodesAt<T>(faces, [&](int node) { return at(x, node) + rules.way(node, infinity); }));
    turning = norm(then.normal - now.normal);
    warp = branchFree::larger(then.warp, warp);
  }
  for (int i = 0; i < branchFree::widthOf<T>; ++i)
  {
    const Real ofNarrow = rules.turningOfNarrow(branchFree::lane(now.width, i));
    new (planes + i) FacePlane{branchFree::lane(now.center, i), branchFree::lane(now.normal, i),
                               branchFree::lane(turning, i) + ofNarrow, branchFree::lane(warp, i)};
  }
}
} // namespace

FacePlane facePlane(const Face& face, const ConstNodeVectors& x, int dimension)
{
  const FaceNodes nodes = nodesAt<Real>(&face, [&](int node) { return at(x, node); });
  const MeanPlane<Real> plane = dimension == 2 ? meanPlane<2>(nodes) : meanPlane<3>(nodes);
  return {plane.center, plane.normal, 0, plane.warp};
}

FacePlane CandidateRules::planeOf(const Face& face, const ConstNodeVectors& x, int dimension) const
{
  FacePlane plane;
  if (dimension == 2)
    putPlanes<2, Real>(&face, x, *this, &plane);
  else
    putPlanes<3, Real>(&face, x, *this, &plane);
  return plane;
}

Array<FacePlane> facePlanes(const Face* faces, std::size_t count, const ConstNodeVectors& x,
                            int dimension, const CandidateRules& rules)
{
  const Array<FacePlane> planes(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::facePlanes"), count);
  const int faceCount = int(count);
  parallelFor("coplane::contact::facePlanes", (faceCount + laneCount - 1) / laneCount,
              [&](const int batch)
              {
                const int first = batch * laneCount;
                const int last = std::min(first + laneCount, faceCount);
                const auto isLikeFirst = [&](const Face& face)
                { return face.count == faces[first].count; };
                if (dimension == 3 && last - first == laneCount &&
                    std::all_of(faces + first, faces + last, isLikeFirst))
                  putPlanes<3, Lanes>(faces + first, x, rules, &planes(first));
                else
                  for (int f = first; f < last; ++f)
                    new (&planes(f)) FacePlane(rules.planeOf(faces[f], x, dimension));
              });
  return planes;
}
} // namespace coplane
