// Checkpoints of free-field columns, and the columns of a run.
#include <coplane_dynamics/FreeField.hpp>

#include <algorithm>

namespace coplane
{
std::string FreeFieldColumn::tableName() const
{
  std::string name = name_;
  std::replace(name.begin(), name.end(), '/', '|');
  return "free_field/" + name;
}

template <class Self, class F>
void FreeFieldColumn::forEachVector(Self& self, F&& f)
{
  for (auto* vectors :
       {&self.displacement_, &self.velocity_, &self.previous_, &self.support_, &self.reaction_})
    for (auto& vector : *vectors)
      f(vector);
}

/// What changes of a column, with the state of its elements.
std::vector<Real> FreeFieldColumn::numbers() const
{
  std::vector<Real> numbers;
  forEachVector(*this,
                [&](const Vec3& vector) {
                  numbers.insert(numbers.end(), {vector.x, vector.y, vector.z});
                });
  for (const LayerElement& element : elements_)
  {
    const ElementBlock& block = blocks_[std::size_t(element.block)];
    const std::size_t first = numbers.size();
    numbers.resize(first + block.stateColumns().size());
    block.saveState(element.element, numbers.data() + first);
  }
  return numbers;
}

void FreeFieldColumn::save(StateTables& out) const
{
  if (!started_)
    return;
  // The window tells columns apart that stand beside one side one after the other.
  std::vector<Real> numbers{when_.from, when_.until};
  const std::vector<Real> changing = this->numbers();
  numbers.insert(numbers.end(), changing.begin(), changing.end());
  out.numbers(tableName(), numbers);
}

void FreeFieldColumn::restore(const StateSource& in)
{
  if (!in.has(tableName()))
    return; // begins later
  const std::vector<Real> numbers = in.numbers(tableName());
  if (numbers.size() > 1 && !when_.overlaps({numbers[0], numbers[1]}))
    return; // of another one beside this side
  std::size_t expected = 2;
  forEachVector(*this, [&](const Vec3&) { expected += 3; });
  for (const LayerElement& element : elements_)
    expected += blocks_[std::size_t(element.block)].stateColumns().size();
  if (numbers.size() != expected)
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the column beside side set '{}' has {} numbers and should have {}. Restart "
                   "with the program that wrote it ({}).",
                   in.name(), name_, numbers.size(), expected, in.program());
  const Real* next = numbers.data() + 2;
  forEachVector(*this,
                [&](Vec3& vector)
                {
                  vector = {next[0], next[1], next[2]};
                  next += 3;
                });
  for (const LayerElement& element : elements_)
  {
    ElementBlock& block = blocks_[std::size_t(element.block)];
    block.restoreState(element.element, next);
    next += block.stateColumns().size();
  }
  placeCorners();
  for (ElementBlock& block : blocks_)
    block.update(x_, v_, 0);
  sumForces();
  started_ = true;
}

void FreeFieldColumn::addTo(StateHash& hash, std::uint64_t field, GlobalId id) const
{
  std::uint64_t component = 0;
  for (const Real number : started_ ? numbers() : std::vector<Real>())
    hash.add(field, id, component++, number);
}

FreeFields::FreeFields(const Model& model, const Comm& comm)
{
  const std::vector<FreeFieldBoundary>& boundaries = model.conditions.freeFields;
  for (std::size_t b = 0; b < boundaries.size(); ++b)
  {
    for (std::size_t other = 0; other < b; ++other)
      if (boundaries[other].name == boundaries[b].name &&
          boundaries[other].when.overlaps(boundaries[b].when))
        failOnAllRanks(ExitCode::Deck,
                       "{}: side set '{}' has a free field already ({}); accepted: one at a time.",
                       boundaries[b].where, boundaries[b].name, boundaries[other].where);
    columns_.emplace_back(b, model, comm);
  }
}

void FreeFields::start(const KickTimes& times, const Conditions& conditions, const RankMesh& mesh,
                       const NodalState& state, const ElementForces& elements, const Comm& comm)
{
  for (std::size_t b = 0; b < columns_.size(); ++b)
    if (!columns_[b].hasStarted() && conditions.freeFields[b].when.holds(times.middle()))
      columns_[b].start(times.t, conditions, mesh, state, elements, comm);
}

void FreeFields::advance(Real dt)
{
  for (FreeFieldColumn& column : columns_)
    column.advance(dt);
}

void FreeFields::kick(const KickTimes& times, const Conditions& conditions, Real massDamping,
                      Real localDamping)
{
  for (FreeFieldColumn& column : columns_)
    column.kick(times, conditions, massDamping, localDamping);
}

void FreeFields::stop(const KickTimes& times, const Conditions& conditions)
{
  for (FreeFieldColumn& column : columns_)
    column.stop(times, conditions);
}

Real FreeFields::stableStep() const
{
  const FreeFieldColumn* const column = columnWithLeastStep();
  return column ? column->stableStep() : infinity;
}

const FreeFieldColumn* FreeFields::columnWithLeastStep() const
{
  const auto least = std::min_element(columns_.begin(), columns_.end(),
                                      [](const FreeFieldColumn& a, const FreeFieldColumn& b)
                                      { return a.stableStep() < b.stableStep(); });
  return least == columns_.end() ? nullptr : &*least;
}

void FreeFields::save(StateTables& out) const
{
  for (const FreeFieldColumn& column : columns_)
    column.save(out);
}

void FreeFields::restore(const StateSource& in)
{
  for (FreeFieldColumn& column : columns_)
    column.restore(in);
}

void FreeFields::addTo(StateHash& hash, std::uint64_t field) const
{
  for (std::size_t b = 0; b < columns_.size(); ++b)
    columns_[b].addTo(hash, field, GlobalId(b));
}
} // namespace coplane
