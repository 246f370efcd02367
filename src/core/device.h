// What a formula needs to compile for the host and for CUDA.
#pragma once

#ifdef __CUDACC__
#define RP_HD __host__ __device__ inline
#define RP_UNROLL _Pragma("unroll")
#else
#define RP_HD inline
#define RP_UNROLL
#endif
