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
  const auto forEachEntry = [&](const auto& visit)
  {
    for (std::size_t p = 0; p < slots.extent(0); ++p)
      for (int side = 0; side < 2; ++side)
        if (const int face = slots(p).face[side]; face >= 0 && std::size_t(face) < localFaces)
          visit(face, std::int32_t(2 * p + side));
  };
  planesStart_ = Array<std::int32_t>("coplane::contact::planesStart", localFaces + 1);
  forEachEntry([&](int face, std::int32_t) { ++planesStart_(face + 1); });
  for (std::size_t f = 0; f < localFaces; ++f)
    planesStart_(f + 1) += planesStart_(f);
  planesEntry_ =
      Array<std::int32_t>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planesEntry"),
                          planesStart_(localFaces));
  // Planes are visited in the order of their keys, so each face's list is in that order on every
  // rank.
  std::vector<std::int32_t> next(planesStart_.data(), planesStart_.data() + localFaces);
  forEachEntry([&](int face, std::int32_t entry) { planesEntry_(next[face]++) = entry; });
}

void ForceSums::listFaces(const std::vector<Face>& localFaces, int ownedNodes)
{
  if (facesStart_.extent(0) == std::size_t(ownedNodes) + 1)
    return;
  faceLoads_ = decltype(faceLoads_)("coplane::contact::faceLoads", localFaces.size());
  facesStart_ = Array<std::int32_t>("coplane::contact::facesStart", ownedNodes + 1);
  const auto forEachCorner = [&](const auto& visit)
  {
    for (std::size_t f = 0; f < localFaces.size(); ++f)
      for (int k = 0; k < localFaces[f].count; ++k)
        if (localFaces[f].nodes[k] < ownedNodes)
          visit(localFaces[f].nodes[k], std::int32_t(4 * f + k));
  };
  forEachCorner([&](int node, std::int32_t) { ++facesStart_(node + 1); });
  for (int n = 0; n < ownedNodes; ++n)
    facesStart_(n + 1) += facesStart_(n);
  facesEntry_ = Array<std::int32_t>("coplane::contact::facesEntry", facesStart_(ownedNodes));
  std::vector<std::int32_t> next(facesStart_.data(), facesStart_.data() + ownedNodes);
  forEachCorner([&](int node, std::int32_t entry) { facesEntry_(next[node]++) = entry; });
}

void ForceSums::add(const Planes& planes, const Array<Activity>& activity, const NodeVectors& f,
                    const Array<Real>& stiffness) const
{
  const auto loads = faceLoads_;
  const auto planesStart = planesStart_, planesEntry = planesEntry_;
  const auto facesStart = facesStart_, facesEntry = facesEntry_;
  const std::int32_t entries = std::int32_t(planesEntry.extent(0));
  constexpr std::int32_t ahead = 6;
  parallelFor(
      "coplane::contact::faceLoads", int(loads.extent(0)), KOKKOS_LAMBDA(const int n) {
        FaceLoad& load = *new (&loads(n)) FaceLoad;
        for (std::int32_t i = planesStart(n); i < planesStart(n + 1); ++i)
        {
          if (i + ahead < entries && activity(planesEntry(i + ahead) / 2) == Activity::Loaded)
            prefetch(planes(planesEntry(i + ahead) / 2));
          if (activity(planesEntry(i) / 2) == Activity::Loaded)
            load.add(planes(planesEntry(i) / 2), planesEntry(i) % 2);
        }
      });
  parallelFor(
      "coplane::contact::addForces", int(facesStart.extent(0)) - 1, KOKKOS_LAMBDA(const int node) {
        Vec3 force = at(f, node);
        Real sum = 0;
        for (std::int32_t i = facesStart(node); i < facesStart(node + 1); ++i)
        {
          const FaceLoad& load = loads(facesEntry(i) / 4);
          force += load.force[facesEntry(i) % 4];
          sum += load.stiffness;
        }
        set(f, node, force);
        stiffness(node) = sum;
      });
}
} // namespace coplane
