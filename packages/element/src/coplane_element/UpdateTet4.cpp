#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateTet4(const ElementKernelData& data)
{
  updateElements<ElementType::Tet4>(data);
}
} // namespace coplane
