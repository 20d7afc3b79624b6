// The faces that contact knows: local ones, then ghosts.
#include <coplane_contact/Contact.hpp>

#include <algorithm>

namespace coplane
{
void Contact::listFaces(const NodeLayout& layout)
{
  faces_ = localFaces_;
  const auto localNode = [&](GlobalId id) { return layout.localNode(id); };
  for (const GhostFace& ghost : ghosts_.faces)
    faces_.push_back(toFace(ghost, localNode));
}

int Contact::faceHere(GlobalId id) const
{
  const auto less = [](const Face& face, GlobalId wanted) { return face.id < wanted; };
  const auto ghosts = faces_.begin() + std::ptrdiff_t(localFaces_.size());
  auto found = std::lower_bound(faces_.begin(), ghosts, id, less);
  if (found == ghosts || found->id != id)
    found = std::lower_bound(ghosts, faces_.end(), id, less);
  return found != faces_.end() && found->id == id ? int(found - faces_.begin()) : -1;
}

void Contact::takeFaceTables()
{
  faceTable_ = Array<Face>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::faces"),
                           faces_.size());
  std::copy(faces_.begin(), faces_.end(), faceTable_.data());
}
} // namespace coplane
