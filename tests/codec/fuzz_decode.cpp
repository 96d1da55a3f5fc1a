#include "exercise.h"

// Built with FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION, so that checksums do not stop the fuzzer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
    exerciseDecoder(bytes, size, 65);
    return 0;
}
