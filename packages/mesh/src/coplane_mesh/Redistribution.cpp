#include <coplane_mesh/Redistribution.hpp>

#include <Teuchos_DefaultMpiComm.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

namespace coplane
{
namespace
{
using Map = Tpetra::Map<int, long long>;
using Import = Tpetra::Import<int, long long>;
using MultiVector = Tpetra::MultiVector<double, int, long long>;

Teuchos::RCP<const Map> makeMap(const Comm& comm, const std::vector<GlobalId>& ids)
{
  const auto teuchos = Teuchos::rcp(new Teuchos::MpiComm<int>(comm.mpi()));
  const std::vector<long long> copy(ids.begin(), ids.end());
  // Index base 0 even though ids start at 1: the base only has to be a lower bound.
  return Teuchos::rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), copy.data(),
                              int(copy.size()), 0, teuchos));
}
} // namespace

struct Redistribution::Implementation
{
  Teuchos::RCP<const Map> source, target;
  Teuchos::RCP<const Import> import;
  // Buffers are kept, since the same exchange runs every cycle.
  mutable Teuchos::RCP<MultiVector> from, to;
};

Redistribution::Redistribution(const Comm& comm, const std::vector<GlobalId>& sourceIds,
                               const std::vector<GlobalId>& targetIds)
    : implementation_(std::make_unique<Implementation>())
{
  implementation_->source = makeMap(comm, sourceIds);
  implementation_->target = makeMap(comm, targetIds);
  implementation_->import =
      Teuchos::rcp(new Import(implementation_->source, implementation_->target));
}

Redistribution::~Redistribution() = default;
Redistribution::Redistribution(Redistribution&&) noexcept = default;
Redistribution& Redistribution::operator=(Redistribution&&) noexcept = default;

void Redistribution::move(const ConstTable<Real>& source, const Table<Real>& target) const
{
  Implementation& it = *implementation_;
  const int columns = int(std::max(source.extent(1), target.extent(1)));
  if (it.from.is_null() || int(it.from->getNumVectors()) != columns)
  {
    it.from = Teuchos::rcp(new MultiVector(it.source, columns));
    it.to = Teuchos::rcp(new MultiVector(it.target, columns));
  }
  {
    const auto view = it.from->getLocalViewHost(Tpetra::Access::OverwriteAll);
    parallelFor(
        "coplane::mesh::packRows", int(view.extent(0)), KOKKOS_LAMBDA(const int i) {
          for (int c = 0; c < columns; ++c)
            view(i, c) = source(i, c);
        });
  }
  it.to->doImport(*it.from, *it.import, Tpetra::INSERT);
  const auto view = it.to->getLocalViewHost(Tpetra::Access::ReadOnly);
  parallelFor(
      "coplane::mesh::unpackRows", int(view.extent(0)), KOKKOS_LAMBDA(const int i) {
        for (int c = 0; c < columns; ++c)
          target(i, c) = view(i, c);
      });
}

std::vector<Real> Redistribution::move(const std::vector<Real>& source) const
{
  Table<Real> from(Kokkos::ViewAllocateWithoutInitializing("from"), source.size(), 1);
  for (std::size_t i = 0; i < source.size(); ++i)
    from(i, 0) = source[i];
  const std::size_t rows = implementation_->target->getNodeNumElements();
  Table<Real> to(Kokkos::ViewAllocateWithoutInitializing("to"), rows, 1);
  move(from, to);
  return std::vector<Real>(to.data(), to.data() + rows);
}
} // namespace coplane
