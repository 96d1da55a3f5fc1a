#pragma once

extern "C" {
int openblas_get_num_threads(void);
void openblas_set_num_threads(int count);
int omp_get_max_active_levels(void);
void omp_set_max_active_levels(int levels);
}

namespace gimg {

/// SuiteSparse runs on one thread while it lives. Its dense kernels sum in an order that depends on their
/// number of threads. And CHOLMOD starts four threads for loops of a few microseconds, whose waiting takes
/// more time than they save.
class OneSolverThread
{
public:
    OneSolverThread() : blasThreads_(openblas_get_num_threads()), levels_(omp_get_max_active_levels())
    {
        openblas_set_num_threads(1);
        omp_set_max_active_levels(0);
    }
    ~OneSolverThread()
    {
        openblas_set_num_threads(blasThreads_);
        omp_set_max_active_levels(levels_);
    }
    OneSolverThread(const OneSolverThread&) = delete;
    OneSolverThread& operator=(const OneSolverThread&) = delete;

private:
    int blasThreads_, levels_;
};

} // namespace gimg
