// SPDX-License-Identifier: Apache-2.0
// Points and vectors of three components. Geometry is made in double, stored fields are float.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace exitance {

template <class T>
struct Vector3 {
    T x{}, y{}, z{};

    constexpr Vector3() = default;
    constexpr Vector3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    template <class U>
    constexpr explicit Vector3(const Vector3<U>& v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

    constexpr T& operator[](std::size_t i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : i == 1 ? y : z; }

    constexpr Vector3& operator+=(const Vector3& v) { return *this = *this + v; }
    constexpr Vector3& operator-=(const Vector3& v) { return *this = *this - v; }
    constexpr Vector3& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vector3 operator+(const Vector3& a, const Vector3& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend constexpr Vector3 operator-(const Vector3& a, const Vector3& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend constexpr Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vector3 operator*(const Vector3& a, T s) {
        return {a.x * s, a.y * s, a.z * s};
    }
    friend constexpr Vector3 operator*(T s, const Vector3& a) { return a * s; }
    friend constexpr Vector3 operator/(const Vector3& a, T s) {
        return {a.x / s, a.y / s, a.z / s};
    }
    friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

using Vec3 = Vector3<double>;
using Vec3f = Vector3<float>;

template <class T>
constexpr T dot(const Vector3<T>& a, const Vector3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
constexpr Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
T length(const Vector3<T>& v) {
    return std::sqrt(dot(v, v));
}

/// `v` scaled to unit length; the zero vector stays zero.
template <class T>
Vector3<T> normalized(const Vector3<T>& v) {
    const T l = length(v);
    return l > T(0) ? v / l : v;
}

template <class T>
bool is_finite(const Vector3<T>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class T>
Vector3<T> min(const Vector3<T>& a, const Vector3<T>& b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

template <class T>
Vector3<T> max(const Vector3<T>& a, const Vector3<T>& b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

}  // namespace exitance
