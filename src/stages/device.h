// What a formula needs to compile for the host and for CUDA.
#pragma once

#ifdef __CUDACC__
#define RP_HD __host__ __device__ inline
#else
#define RP_HD inline
#endif
