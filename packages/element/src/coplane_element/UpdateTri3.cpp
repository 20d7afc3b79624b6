#include <coplane_element/detail/ElementKernel.hpp>

namespace coplane
{
template <class Law>
using Tri3Kernel = ElementKernel<ElementType::Tri3, Law>;

void updateTri3(const ElementKernelData& data)
{
  runWithLaw<Tri3Kernel>(data);
}
} // namespace coplane
