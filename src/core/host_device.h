// What a formula needs to compile for the host and for CUDA.
#pragma once

#ifdef __CUDACC__
#define RP_HD __host__ __device__ inline
#else
#define RP_HD inline
#endif

/// Before a loop: so that arrays indexed in it stay in a GPU's registers. nvcc hands the host's
/// half of a file to the host's compiler, which does not know the pragma.
#ifdef __CUDA_ARCH__
#define RP_UNROLL _Pragma("unroll")
#else
#define RP_UNROLL
#endif
