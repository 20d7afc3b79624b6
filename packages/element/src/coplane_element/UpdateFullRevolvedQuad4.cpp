#include <coplane_element/detail/FullKernel.hpp>

namespace coplane
{
template <class Law>
using FullRevolvedQuad4Kernel = FullKernel<ElementType::Quad4, Law, Geometry::Axisymmetric>;

void updateFullRevolvedQuad4(const ElementKernelData& data)
{
  runWithLaw<FullRevolvedQuad4Kernel>(data);
}
} // namespace coplane
