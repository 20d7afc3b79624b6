#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateTri3(const ElementKernelData& data)
{
  updateElements<ElementType::Tri3>(data);
}
} // namespace coplane
