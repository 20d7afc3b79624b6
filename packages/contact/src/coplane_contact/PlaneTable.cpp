#include <coplane_contact/PlaneTable.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>

namespace coplane
{
namespace
{
PlaneTable::Planes planesFor(std::size_t count)
{
  return PlaneTable::Planes(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planes"),
                            count);
}
} // namespace

PlaneTable::PlaneTable(const ContactRules& rules)
    : laws_("coplane::contact::laws", rules.joints.size())
{
  for (std::size_t j = 0; j < rules.joints.size(); ++j)
    laws_(j) = rules.joints[j].law;
}

PairTables PlaneTable::forKernels(bool incremental)
{
  return {planes_.data(),     slotFaces_.data(), activity_.data(), todo_.data(),
          preparation_.get(), laws_.data(),      incremental,      &passedOnHasChanged_};
}

void PlaneTable::take(const Planes& planes, const Todos& todo,
                      std::shared_ptr<const Preparation> preparation)
{
  planes_ = planes;
  todo_ = todo;
  preparation_ = std::move(preparation);
  passedOnHasChanged_ = false;
  slotFaces_ = Slots("coplane::contact::slotFaces", count());
  activity_ = Array<Activity>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::activity"),
                              count());
  parallelFor("coplane::contact::slotFaces", int(count()),
              [&](const int p)
              {
                activity_(p) = activityOf(planes_(p));
                for (int side = 0; side < 2; ++side)
                  slotFaces_(p).face[side] = planes_(p).face[side];
              });
}

void PlaneTable::forgetPreparation()
{
  preparation_.reset();
  todo_ = {};
}

void PlaneTable::keepOnly(const std::vector<std::size_t>& places)
{
  const Planes next = planesFor(places.size());
  const Array<Activity> activity("coplane::contact::activity", places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    new (&next(i)) Plane(planes_(places[i]));
    activity(i) = activity_(places[i]);
  }
  planes_ = next;
  activity_ = activity;
  todo_ = {};
}

void PlaneTable::prepareAll()
{
  parallelFor("coplane::contact::prepareAll", int(todo_.extent(0)),
              [&](const int slot)
              {
                if (todo_(slot) != 0)
                  preparation_->prepare(slot, todo_(slot), planes_(slot));
                todo_(slot) = 0;
              });
}

Plane PlaneTable::prepared(std::size_t p) const
{
  Plane plane = planes_(p);
  if (todo_.extent(0) > 0 && todo_(p) != 0)
    preparation_->prepare(int(p), todo_(p), plane);
  return plane;
}
} // namespace coplane
