#include <coplane_contact/SubsteppedPairs.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
std::vector<int> sortedOnce(std::vector<int> numbers)
{
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::size_t placeOf(const std::vector<int>& sorted, int number)
{
  return std::size_t(std::lower_bound(sorted.begin(), sorted.end(), number) - sorted.begin());
}
} // namespace

void SubsteppedPairs::list(const SlotTable& slots, const std::vector<Face>& faces,
                           std::size_t localFaces, int ownedNodes, const Array<Real>& steps)
{
  clear();
  std::vector<char> isAt(faces.size(), 0); // such a node
  for (std::size_t f = 0; f < faces.size(); ++f)
    isAt[f] = std::any_of(faces[f].nodes, faces[f].nodes + faces[f].count,
                          [&](int node) { return steps(node) > 1; });
  has_.assign(slots.extent(0), 0);
  std::vector<int> local; // faces that have such pairs
  for (std::size_t p = 0; p < slots.extent(0); ++p)
  {
    const std::int32_t* const pair = slots(p).face;
    if (pair[0] < 0 || (isAt[std::size_t(pair[0])] == 0 && isAt[std::size_t(pair[1])] == 0) ||
        faces[std::size_t(pair[0])].rigid || faces[std::size_t(pair[1])].rigid)
      continue;
    has_[p] = 1;
    slots_.push_back(int(p));
    for (int side = 0; side < 2; ++side)
      if (std::size_t(pair[side]) < localFaces)
        local.push_back(pair[side]);
  }
  local = sortedOnce(std::move(local));
  planesOfFace_ = {local.size(), [&](const auto& visit)
                   {
                     for (const int p : slots_)
                       for (int side = 0; side < 2; ++side)
                         if (const int face = slots(p).face[side]; std::size_t(face) < localFaces)
                           visit(placeOf(local, face), std::int32_t(2 * p + side));
                   }};
  const auto forEachCorner = [&](const auto& visit)
  {
    for (std::size_t i = 0; i < local.size(); ++i)
      for (int k = 0; k < faces[std::size_t(local[i])].count; ++k)
        if (const int node = faces[std::size_t(local[i])].nodes[k]; node < ownedNodes)
          visit(node, std::int32_t(4 * i + k));
  };
  forEachCorner([&](int node, std::int32_t) { nodes_.push_back(node); });
  nodes_ = sortedOnce(std::move(nodes_));
  facesOfNode_ = {nodes_.size(), [&](const auto& visit) {
                    forEachCorner([&](int node, std::int32_t entry)
                                  { visit(placeOf(nodes_, node), entry); });
                  }};
}

void SubsteppedPairs::listNearFaces(const SlotTable& slots)
{
  nearFaces_.clear();
  for (const int slot : near_)
    nearFaces_.insert(nearFaces_.end(), slots(slot).face, slots(slot).face + 2);
  nearFaces_ = sortedOnce(std::move(nearFaces_));
}

std::vector<int> SubsteppedPairs::othersOf(const std::vector<int>& near) const
{
  std::vector<int> others;
  std::copy_if(near.begin(), near.end(), std::back_inserter(others),
               [&](int slot) { return !has(std::size_t(slot)); });
  return others;
}

void SubsteppedPairs::addForces(Plane* const* planes, const Array<Activity>& activity,
                                const NodeVectors& force) const
{
  std::vector<FaceLoad> loads(planesOfFace_.count());
  parallelFor("coplane::contact::substeppedLoads", int(loads.size()),
              [&](const int face)
              {
                for (const std::int32_t entry : planesOfFace_[std::size_t(face)])
                  if (activity(entry / 2) == Activity::Loaded)
                    loads[std::size_t(face)].add(*planes[entry / 2], entry % 2);
              });
  parallelFor("coplane::contact::substeppedForces", int(nodes_.size()),
              [&](const int i)
              {
                const int node = nodes_[std::size_t(i)];
                Vec3 sum = at(force, node);
                for (const std::int32_t entry : facesOfNode_[std::size_t(i)])
                  sum += loads[std::size_t(entry / 4)].force[entry % 4];
                set(force, node, sum);
              });
}
} // namespace coplane
