#include <coplane_element/detail/ElementKernel.hpp>

namespace coplane
{
template <class Law>
using Quad4Kernel = ElementKernel<ElementType::Quad4, Law>;

void updateQuad4(const ElementKernelData& data)
{
  runWithLaw<Quad4Kernel>(data);
}
} // namespace coplane
