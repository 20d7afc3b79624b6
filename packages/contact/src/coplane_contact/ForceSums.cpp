#include <coplane_contact/ForceSums.hpp>

namespace coplane
{
namespace
{
/// Brings what FaceLoad::add() reads of a plane into the cache.
void prefetch(const Plane& plane)
{
  const char* line = reinterpret_cast<const char*>(&plane);
  for (int i = 0; i < 3; ++i)
    __builtin_prefetch(line + 64 * i);
}
} // namespace

void ForceSums::listPlanes(const SlotTable& slots, std::size_t localFaces)
{
  // Planes are visited in the order of their keys, so each face's list is in that order on every
  // rank.
  planesOfFace_ = {localFaces, [&](const auto& visit)
                   {
                     for (std::size_t p = 0; p < slots.extent(0); ++p)
                       for (int side = 0; side < 2; ++side)
                         if (const int face = slots(p).face[side];
                             face >= 0 && std::size_t(face) < localFaces)
                           visit(std::size_t(face), std::int32_t(2 * p + side));
                   }};
}

void ForceSums::listFaces(const std::vector<Face>& localFaces, int ownedNodes)
{
  if (facesOfNode_.count() == std::size_t(ownedNodes))
    return;
  faceLoads_ = decltype(faceLoads_)("coplane::contact::faceLoads", localFaces.size());
  facesOfNode_ = {std::size_t(ownedNodes), [&](const auto& visit)
                  {
                    for (std::size_t f = 0; f < localFaces.size(); ++f)
                      for (int k = 0; k < localFaces[f].count; ++k)
                        if (const int node = localFaces[f].nodes[k]; node < ownedNodes)
                          visit(std::size_t(node), std::int32_t(4 * f + k));
                  }};
}

void ForceSums::add(Plane* const* planes, const Array<Activity>& activity, const NodeVectors& f,
                    const Array<Real>& stiffness) const
{
  const auto loads = faceLoads_;
  const auto planesOfFace = planesOfFace_.view(), facesOfNode = facesOfNode_.view();
  const std::int32_t* const end = planesOfFace_.entries().data() + planesOfFace_.entries().size();
  constexpr std::int32_t ahead = 6;
  parallelFor(
      "coplane::contact::faceLoads", int(loads.extent(0)), KOKKOS_LAMBDA(const int n) {
        FaceLoad& load = *new (&loads(n)) FaceLoad;
        for (const std::int32_t& entry : planesOfFace[n])
        {
          if (end - &entry > ahead && activity((&entry)[ahead] / 2) == Activity::Loaded)
            prefetch(*planes[(&entry)[ahead] / 2]);
          if (activity(entry / 2) == Activity::Loaded)
            load.add(*planes[entry / 2], entry % 2);
        }
      });
  parallelFor(
      "coplane::contact::addForces", int(facesOfNode_.count()), KOKKOS_LAMBDA(const int node) {
        Vec3 force = at(f, node);
        Real sum = 0;
        for (const std::int32_t entry : facesOfNode[node])
        {
          const FaceLoad& load = loads(entry / 4);
          force += load.force[entry % 4];
          sum += load.stiffness;
        }
        set(f, node, force);
        stiffness(node) = sum;
      });
}
} // namespace coplane
