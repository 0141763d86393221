// Four single-precision numbers at once, as every x86-64 and every arm64 has them.
#pragma once
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__ARM_NEON) && defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace deburr {

#if defined(__SSE2__)

struct Float4 {
    __m128 v;
    Float4() = default;
    explicit Float4(float x) : v(_mm_set1_ps(x)) {}
    explicit Float4(__m128 x) : v(x) {}
    static Float4 load(const float* aligned) { return Float4(_mm_load_ps(aligned)); }
    void store(float* aligned) const { _mm_store_ps(aligned, v); }
    friend Float4 operator-(Float4 a, Float4 b) { return Float4(_mm_sub_ps(a.v, b.v)); }
    friend Float4 operator*(Float4 a, Float4 b) { return Float4(_mm_mul_ps(a.v, b.v)); }
    friend Float4 min(Float4 a, Float4 b) { return Float4(_mm_min_ps(a.v, b.v)); }
    friend Float4 max(Float4 a, Float4 b) { return Float4(_mm_max_ps(a.v, b.v)); }
    /// Bit k: a[k] ≤ b[k].
    friend unsigned not_above(Float4 a, Float4 b) { return unsigned(_mm_movemask_ps(_mm_cmple_ps(a.v, b.v))); }
};

#elif defined(__ARM_NEON) && defined(__aarch64__)

struct Float4 {
    float32x4_t v;
    Float4() = default;
    explicit Float4(float x) : v(vdupq_n_f32(x)) {}
    explicit Float4(float32x4_t x) : v(x) {}
    static Float4 load(const float* aligned) { return Float4(vld1q_f32(aligned)); }
    void store(float* aligned) const { vst1q_f32(aligned, v); }
    friend Float4 operator-(Float4 a, Float4 b) { return Float4(vsubq_f32(a.v, b.v)); }
    friend Float4 operator*(Float4 a, Float4 b) { return Float4(vmulq_f32(a.v, b.v)); }
    friend Float4 min(Float4 a, Float4 b) { return Float4(vminq_f32(a.v, b.v)); }
    friend Float4 max(Float4 a, Float4 b) { return Float4(vmaxq_f32(a.v, b.v)); }
    friend unsigned not_above(Float4 a, Float4 b) {
        const uint32_t bits[4] = {1, 2, 4, 8};
        return vaddvq_u32(vandq_u32(vcleq_f32(a.v, b.v), vld1q_u32(bits)));
    }
};

#else

struct Float4 {
    float v[4];
    Float4() = default;
    explicit Float4(float x) : v{x, x, x, x} {}
    static Float4 load(const float* p) {
        return each([&](int k) { return p[k]; });
    }
    void store(float* p) const {
        for (int k = 0; k < 4; ++k) p[k] = v[k];
    }
    friend Float4 operator-(Float4 a, Float4 b) {
        return each([&](int k) { return a.v[k] - b.v[k]; });
    }
    friend Float4 operator*(Float4 a, Float4 b) {
        return each([&](int k) { return a.v[k] * b.v[k]; });
    }
    friend Float4 min(Float4 a, Float4 b) {
        return each([&](int k) { return a.v[k] < b.v[k] ? a.v[k] : b.v[k]; });
    }
    friend Float4 max(Float4 a, Float4 b) {
        return each([&](int k) { return a.v[k] > b.v[k] ? a.v[k] : b.v[k]; });
    }
    friend unsigned not_above(Float4 a, Float4 b) {
        unsigned bits = 0;
        for (int k = 0; k < 4; ++k) bits |= unsigned(a.v[k] <= b.v[k]) << k;
        return bits;
    }

private:
    template <class F>
    static Float4 each(F f) {
        Float4 r(0.0f);
        for (int k = 0; k < 4; ++k) r.v[k] = f(k);
        return r;
    }
};

#endif

}  // namespace deburr
