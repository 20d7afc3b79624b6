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

void addTo(StateHash& hash, std::uint64_t what, const Plane& plane)
{
  std::uint64_t component = mix(std::uint64_t(plane.faceId[1]));
  forEachNumber(plane, [&](const auto& number)
                { hash.add(what, plane.faceId[0], component++, Real(number)); });
}
} // namespace coplane
