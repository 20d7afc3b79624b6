#pragma once

#include <coplane_core/Backend.hpp>
#include <coplane_core/Lanes.hpp>

#include <string>
#include <type_traits>

namespace coplane
{
/// One number per component (row) and element (column). Copies refer to the same numbers, as those
/// of a Kokkos::View do.
///
/// All rows of the laneCount elements of a batch lie beside each other. A kernel then walks through
/// one stretch of memory per table; with a stretch per row hexahedra would walk through 45, more
/// than processors follow.
template <class T>
class ElementTableOf
{
public:
  ElementTableOf() = default;
  /// All zero.
  /// @param columns a multiple of laneCount
  ElementTableOf(const std::string& label, int rows, int columns)
      : values_(label, std::size_t(rows) * std::size_t(columns)), rows_(rows), columns_(columns)
  {
  }

  /// The same numbers, to be read only.
  operator ElementTableOf<const T>() const { return {values_, rows_, columns_}; }

  KOKKOS_FORCEINLINE_FUNCTION T& operator()(std::size_t row, std::size_t column) const
  {
    const std::size_t batch = column / laneCount, lane = column % laneCount;
    return values_((batch * rows_ + row) * laneCount + lane);
  }

  /// Rows for 0, columns for 1.
  KOKKOS_FORCEINLINE_FUNCTION std::size_t extent(int dimension) const
  {
    return dimension == 0 ? rows_ : columns_;
  }

  /// What a batch has, one row after the other.
  KOKKOS_FORCEINLINE_FUNCTION const T* batch(std::size_t batch) const
  {
    return values_.data() + batch * rows_ * laneCount;
  }

  void fill(Real value) const { Kokkos::deep_copy(values_, value); }

private:
  friend class ElementTableOf<std::remove_const_t<T>>;
  ElementTableOf(const Array<T>& values, std::size_t rows, std::size_t columns)
      : values_(values), rows_(rows), columns_(columns)
  {
  }

  Array<T> values_;
  std::size_t rows_ = 0, columns_ = 0;
};
using ElementTable = ElementTableOf<Real>;
using ConstElementTable = ElementTableOf<const Real>;
} // namespace coplane
