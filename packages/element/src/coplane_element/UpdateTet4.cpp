#include <coplane_element/ElementKernel.hpp>

namespace coplane
{
void updateTet4(const ElementKernelData& data, const Material& law)
{
  updateElements<ElementType::Tet4>(data, law);
}
} // namespace coplane
