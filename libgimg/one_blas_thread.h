#pragma once

extern "C" {
int openblas_get_num_threads(void);
void openblas_set_num_threads(int count);
}

namespace gimg {

/// One BLAS thread while it lives: SuiteSparse's dense kernels sum in an order that depends on their number.
class OneBlasThread
{
public:
    OneBlasThread() : before_(openblas_get_num_threads()) { openblas_set_num_threads(1); }
    ~OneBlasThread() { openblas_set_num_threads(before_); }
    OneBlasThread(const OneBlasThread&) = delete;
    OneBlasThread& operator=(const OneBlasThread&) = delete;

private:
    int before_;
};

} // namespace gimg
