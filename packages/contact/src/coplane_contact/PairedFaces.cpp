#include <coplane_contact/PairedFaces.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>

namespace coplane
{
namespace
{
/// What step A needs of the first face, or of as many as T has lanes.
template <class T>
void gatherNodes(const Face* faces, const ConstNodeVectors& x, const ConstNodeVectors& v,
                 FaceNodesOf<T>& nodes)
{
  nodes.count = faces[0].count;
  nodes.mass = branchFree::gathered<T>([&](int i) { return faces[i].mass; });
  for (int k = 0; k < nodes.count; ++k)
  {
    const auto each = [&](const auto& get)
    { return branchFree::gathered<T>([&](int i) { return get(faces[i].nodes[k]); }); };
    const auto vector = [&](const ConstNodeVectors& field) -> Vec3Of<T>
    {
      return {each([&](int node) { return field(node, 0); }),
              each([&](int node) { return field(node, 1); }),
              each([&](int node) { return field(node, 2); })};
    };
    nodes.x[k] = vector(x);
    nodes.v[k] = vector(v);
  }
}

/// Step A for one face.
template <int Dim>
KOKKOS_INLINE_FUNCTION void putFace(const FaceNodes& nodes, ContactOptions::Forces forces, Real dt,
                                    HalfStepFace& face)
{
  new (&face) HalfStepFace(forces == ContactOptions::Forces::Potential
                               ? stepA_faceAtEnd<Dim>(nodes)
                               : stepA_halfStepFace<Dim>(nodes, dt));
}
} // namespace

void PairedFaces::mark(const Kokkos::View<SlotFaces*, Kokkos::HostSpace>& slots,
                       std::size_t faceCount)
{
  halfStep_ = decltype(halfStep_)(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::halfStepFaces"), faceCount);
  paired_ = Array<bool>("coplane::contact::paired", faceCount);
  for (std::size_t p = 0; p < slots.extent(0); ++p)
    for (const int face : slots(p).face)
      if (face >= 0)
        paired_(face) = true;
}

void PairedFaces::stepA(const Array<Face>& faces, int dimension, const ConstNodeVectors& x,
                        const ConstNodeVectors& v, ContactOptions::Forces forces, Real dt) const
{
  const auto halfStep = halfStep_;
  const auto paired = paired_;
  const auto halfStepOf = KOKKOS_LAMBDA(const int f)
  {
    if (!paired(f))
      return;
    FaceNodes nodes;
    gatherNodes(&faces(f), x, v, nodes);
    if (dimension == 2)
      putFace<2>(nodes, forces, dt, halfStep(f));
    else
      putFace<3>(nodes, forces, dt, halfStep(f));
  };
  const int faceCount = int(faces.extent(0));
  parallelFor(
      "coplane::contact::stepA_halfStepFace", (faceCount + laneCount - 1) / laneCount,
      KOKKOS_LAMBDA(const int batch) {
        const int first = batch * laneCount;
        const int last = first + laneCount < faceCount ? first + laneCount : faceCount;
        bool alike = dimension == 3 && last - first == laneCount;
        for (int f = first; f < last; ++f)
          alike = alike && paired(f) && faces(f).count == faces(first).count;
        if (!alike)
        {
          for (int f = first; f < last; ++f)
            halfStepOf(f);
          return;
        }
        FaceNodesOf<Lanes> nodes;
        gatherNodes(&faces(first), x, v, nodes);
        stepA_faces(nodes, forces, dt, &halfStep(first));
      });
}
} // namespace coplane
