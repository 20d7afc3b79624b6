#include <coplane_contact/Preparation.hpp>
#include <coplane_contact/detail/EdgesOfSurfaces.hpp>
#include <coplane_mesh/NodeLayout.hpp>

namespace coplane
{
struct Preparation::Edges
{
  const Search search;
  const EdgesOfSurfaces ofSurfaces; ///< refers to the pairs

  Edges(Search made, const Heritage::Place& place, const Array<FacePlane>& planes,
        const std::vector<Mirror>& mirrors, const NodeLayout& layout)
      : search(std::move(made)), ofSurfaces(search.pairs, place.faces, search.localFaces, planes,
                                            place.x, place.dimension, mirrors, layout)
  {
  }
  Edges(const Edges&) = delete;
};

Preparation::Preparation(Search search, const Heritage::Place& place,
                         const Array<FacePlane>& planes, const std::vector<Mirror>& mirrors,
                         std::shared_ptr<const Heritage> heritage, const NodeLayout& layout)
    : edges_(std::make_shared<const Edges>(std::move(search), place, planes, mirrors, layout)),
      heritage_(std::move(heritage))
{
}

void Preparation::prepare(std::size_t slot, Todo todo, Plane& plane) const
{
  const Real sharedBefore = (todo & WasSeen) != 0 ? plane.overlap : -1;
  if ((todo & LookAtEdges) != 0)
    edges_->ofSurfaces.look(std::size_t(edges_->search.pairOfSlot[slot]), plane);
  if ((todo & TakeOver) != 0)
    heritage_->passOn(plane, sharedBefore);
}
} // namespace coplane
