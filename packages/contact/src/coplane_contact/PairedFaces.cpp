#include <coplane_contact/PairedFaces.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>

#include <algorithm>
#include <iterator>

namespace coplane
{
namespace
{
/// What step A needs of a face, or of as many as T has lanes.
template <class T>
void gatherNodes(const Array<Face>& faces, const int* places, const ConstNodeVectors& x,
                 const ConstNodeVectors& v, FaceNodesOf<T>& nodes)
{
  nodes.count = faces(places[0]).count;
  nodes.mass = branchFree::gathered<T>([&](int i) { return faces(places[i]).mass; });
  for (int k = 0; k < nodes.count; ++k)
  {
    const auto each = [&](const auto& get)
    { return branchFree::gathered<T>([&](int i) { return get(faces(places[i]).nodes[k]); }); };
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
  std::vector<char> isPaired(faceCount, 0);
  for (std::size_t p = 0; p < slots.extent(0); ++p)
    for (const int face : slots(p).face)
      if (face >= 0)
        isPaired[std::size_t(face)] = 1;
  paired_.clear();
  for (std::size_t f = 0; f < faceCount; ++f)
    if (isPaired[f] != 0)
      paired_.push_back(int(f));
  found_.clear();
  motion_ = {};
}

void PairedFaces::stepA(const Motion& motion, const std::vector<int>& places)
{
  motion_ = motion;
  find(places);
  found_ = places;
}

void PairedFaces::stepA(const Motion& motion)
{
  stepA(motion, paired_);
}

const HalfStepFace* PairedFaces::all() const
{
  if (found_.size() < paired_.size())
  {
    if (motion_.x.extent(0) == 0)
      fail(ExitCode::Internal, "Faces of contact are asked for before the first step A.");
    std::vector<int> missing;
    std::set_difference(paired_.begin(), paired_.end(), found_.begin(), found_.end(),
                        std::back_inserter(missing));
    find(missing);
    found_ = paired_;
  }
  return data();
}

void PairedFaces::find(const std::vector<int>& places) const
{
  const Motion& motion = motion_;
  const auto halfStep = halfStep_;
  const auto findOne = [&](const int place)
  {
    FaceNodes nodes;
    gatherNodes(motion.faces, &place, motion.x, motion.v, nodes);
    if (motion.dimension == 2)
      putFace<2>(nodes, motion.forces, motion.dt, halfStep(place));
    else
      putFace<3>(nodes, motion.forces, motion.dt, halfStep(place));
  };
  const int count = int(places.size());
  parallelFor("coplane::contact::stepA_halfStepFace", (count + laneCount - 1) / laneCount,
              [&](const int batch)
              {
                const int first = batch * laneCount, last = std::min(first + laneCount, count);
                const int* const some = places.data() + first;
                bool alike = motion.dimension == 3 && last - first == laneCount;
                for (int i = 0; i < last - first; ++i)
                  alike = alike && motion.faces(some[i]).count == motion.faces(some[0]).count;
                if (!alike)
                {
                  std::for_each(some, some + last - first, findOne);
                  return;
                }
                FaceNodesOf<Lanes> nodes;
                gatherNodes(motion.faces, some, motion.x, motion.v, nodes);
                HalfStepFace* faces[laneCount];
                for (int i = 0; i < laneCount; ++i)
                  faces[i] = &halfStep(some[i]);
                stepA_faces(nodes, motion.forces, motion.dt, faces);
              });
}
} // namespace coplane
