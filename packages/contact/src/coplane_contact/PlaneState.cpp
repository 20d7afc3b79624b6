#include <coplane_contact/PlaneState.hpp>

namespace coplane
{
namespace
{
template <class T>
void addNames(const std::string& name, const T& value, std::vector<std::string>& names)
{
  if constexpr (std::is_array_v<T>)
    for (std::size_t i = 0; i < std::extent_v<T>; ++i)
      addNames(name + "_" + std::to_string(i), value[i], names);
  else if constexpr (std::is_same_v<T, Vec3>)
    for (const char* const axis : {"_x", "_y", "_z"})
      names.push_back(name + axis);
  else
    names.push_back(name);
}

/// As forEachPart, of two at once.
template <class T, class F>
void forEachPartOfTwo(const T& a, const T& b, const F& f)
{
  if constexpr (std::is_array_v<T>)
    for (std::size_t i = 0; i < std::extent_v<T>; ++i)
      forEachPartOfTwo(a[i], b[i], f);
  else if constexpr (std::is_same_v<T, Vec3>)
    for (int c = 0; c < 3; ++c)
      f(a[c], b[c]);
  else
    f(a, b);
}
} // namespace

std::vector<std::string> namesOfNumbers()
{
  std::vector<std::string> names;
  const Plane plane;
  forEachMember(
      [&](const auto& member)
      {
        if (!member.leftOut)
          addNames(member.name, member.get(plane), names);
      });
  return names;
}

bool sameNumbers(const Plane& a, const Plane& b)
{
  bool same = true;
  forEachMember(
      [&](const auto& member)
      {
        if (!member.leftOut)
          forEachPartOfTwo(member.get(a), member.get(b),
                           [&](const auto& one, const auto& other)
                           { same = same && one == other; });
      });
  return same;
}

void addTo(StateHash& hash, std::uint64_t what, const Plane& plane)
{
  std::uint64_t component = mix(std::uint64_t(plane.faceId[1]));
  forEachNumber(plane, [&](const auto& number)
                { hash.add(what, plane.faceId[0], component++, Real(number)); });
}
} // namespace coplane
