#include <coplane_contact/detail/DirectionsOfNodes.hpp>

namespace coplane
{
DirectionsOfNodes::DirectionsOfNodes(int nodes) : numbers_("coplane::contact::numbers", nodes)
{
  for (NodeVectors& of : directions_)
    of = NodeVectors("coplane::contact::directions", nodes);
}

int DirectionsOfNodes::count(int node) const
{
  int count = 0;
  while (count < most && dot(direction(node, count), direction(node, count)) > 0)
    ++count;
  return count;
}

int DirectionsOfNodes::find(int node, const Vec3& direction) const
{
  for (int i = 0; i < most; ++i)
    if (dot(this->direction(node, i), direction) > one)
      return i;
  return -1;
}

void DirectionsOfNodes::add(int node, const Vec3& direction, int number)
{
  Vec3 numbers = at(numbers_, node);
  if (const int known = find(node, direction); known >= 0)
    numbers[known] = numbers[known] == number ? number : -1;
  else if (const int next = count(node); next < most)
  {
    set(directions_[next], node, direction);
    numbers[next] = number;
  }
  set(numbers_, node, numbers);
}

void DirectionsOfNodes::refresh(const NodeLayout& layout) const
{
  layout.refresh(directions_[0], directions_[1]);
  layout.refresh(directions_[2], numbers_);
}
} // namespace coplane
