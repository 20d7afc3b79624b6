#include <coplane_element/detail/ElementKernel.hpp>

namespace coplane
{
template <class Law>
using RevolvedTri3Kernel = ElementKernel<ElementType::Tri3, Law, Geometry::Axisymmetric>;

void updateRevolvedTri3(const ElementKernelData& data)
{
  runWithLaw<RevolvedTri3Kernel>(data);
}
} // namespace coplane
