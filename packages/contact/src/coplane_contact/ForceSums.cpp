#include <coplane_contact/ForceSums.hpp>

namespace coplane
{
void ForceSums::listPlanes(const SlotTable& slots, std::size_t localFaces, std::size_t faces)
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
  loaded_ = Array<std::int32_t>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::loaded"),
                                planesOfFace_.entries().size());
  loadedCount_ = Array<std::int32_t>("coplane::contact::loadedCount", localFaces);
  changed_ = Array<std::uint8_t>("coplane::contact::changed", faces);
  Kokkos::deep_copy(changed_, std::uint8_t(1));
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

void ForceSums::listLoaded(const Array<Activity>& activity) const
{
  const auto planesOfFace = planesOfFace_.view();
  const auto loaded = loaded_, loadedCount = loadedCount_;
  const auto changed = changed_;
  parallelFor(
      "coplane::contact::listLoaded", int(loadedCount.extent(0)), KOKKOS_LAMBDA(const int face) {
        if (changed(face) == 0)
          return;
        changed(face) = 0;
        std::int32_t* const first = loaded.data() + planesOfFace.start[face];
        std::int32_t* next = first;
        for (const std::int32_t entry : planesOfFace[face])
          if (activity(entry / 2) == Activity::Loaded)
            *next++ = entry;
        loadedCount(face) = std::int32_t(next - first);
      });
}

void ForceSums::add(Plane* const* planes, const Array<Activity>& activity, const NodeVectors& f,
                    const Array<Real>& stiffness) const
{
  listLoaded(activity);
  const auto loads = faceLoads_;
  const int* const start = planesOfFace_.view().start;
  const auto facesOfNode = facesOfNode_.view();
  const auto loaded = loaded_, loadedCount = loadedCount_;
  const int faces = int(loads.extent(0));
  constexpr int ahead = 3; // faces
  parallelFor(
      "coplane::contact::faceLoads", faces, KOKKOS_LAMBDA(const int face) {
        const auto loadedOf = [&](int of) -> Stretch<std::int32_t>
        {
          const std::int32_t* const first = loaded.data() + start[of];
          return {first, first + loadedCount(of)};
        };
        if (face + ahead < faces)
          for (const std::int32_t entry : loadedOf(face + ahead))
            FaceLoad::prefetchFrom(*planes[entry / 2], entry % 2);
        if (loadedCount(face) == 0)
          return;
        FaceLoad& load = *new (&loads(face)) FaceLoad;
        for (const std::int32_t entry : loadedOf(face))
          load.add(*planes[entry / 2], entry % 2);
      });
  parallelFor(
      "coplane::contact::addForces", int(facesOfNode_.count()), KOKKOS_LAMBDA(const int node) {
        Vec3 force = at(f, node);
        Real sum = 0;
        for (const std::int32_t entry : facesOfNode[node])
        {
          if (loadedCount(entry / 4) == 0)
            continue;
          const FaceLoad& load = loads(entry / 4);
          force += load.force[entry % 4];
          sum += load.stiffness;
        }
        set(f, node, force);
        stiffness(node) = sum;
      });
}
} // namespace coplane
