#include <coplane_element/detail/ElementKernel.hpp>

namespace coplane
{
template <class Law>
using RevolvedQuad4Kernel = ElementKernel<ElementType::Quad4, Law, Geometry::Axisymmetric>;

void updateRevolvedQuad4(const ElementKernelData& data)
{
  runWithLaw<RevolvedQuad4Kernel>(data);
}
} // namespace coplane
