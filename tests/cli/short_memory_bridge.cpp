/* operator new of Weft's own C++ (see short_memory.h, which is C). */
#include <cstddef>
#include <new>

extern "C" {
bool short_memory_fails(const void *caller);
void *__real__Znwm(std::size_t size);
void *__wrap__Znwm(std::size_t size);
}

void *__wrap__Znwm(std::size_t size)
{
    if (short_memory_fails(__builtin_return_address(0)))
        throw std::bad_alloc();
    return __real__Znwm(size);
}
