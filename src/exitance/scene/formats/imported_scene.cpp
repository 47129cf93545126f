// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/imported_scene.h"

#include <concepts>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace exitance {

namespace {

// One list of members serves both directions.

class Packer {
  public:
    std::string take() { return std::move(bytes_); }

    template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void operator()(const T& value) { raw(&value, 1); }
    void operator()(const Vec3& v) { raw(&v.x, 3); }
    void operator()(const std::string& text) {
        (*this)(std::uint64_t{text.size()});
        raw(text.data(), text.size());
    }
    template <class T>
    void operator()(const std::optional<T>& value) {
        (*this)(value.has_value());
        if (value) (*this)(*value);
    }
    template <class T, std::size_t n>
    void operator()(const std::array<T, n>& values) {
        for (const T& value : values) (*this)(value);
    }
    template <class T>
    void operator()(const std::vector<T>& values) {
        (*this)(std::uint64_t{values.size()});
        for (const T& value : values) item(value);
    }

  private:
    template <class T>
    void raw(const T* values, std::size_t count) {
        bytes_.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    }
    template <class T>
    void item(const T& value);

    std::string bytes_;
};

class Unpacker {
  public:
    explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}
    bool ended() const { return bytes_.empty(); }

    template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
    void operator()(T& value) { raw(&value, 1); }
    void operator()(bool& value) {
        std::uint8_t byte = 0;
        raw(&byte, 1);
        value = byte != 0;
    }
    void operator()(Vec3& v) { raw(&v.x, 3); }
    void operator()(std::string& text) {
        const std::size_t n = count();
        text.assign(bytes_.substr(0, n));
        bytes_.remove_prefix(n);
    }
    template <class T>
    void operator()(std::optional<T>& value) {
        bool there = false;
        (*this)(there);
        if (there) (*this)(value.emplace());
    }
    template <class T, std::size_t n>
    void operator()(std::array<T, n>& values) {
        for (T& value : values) (*this)(value);
    }
    template <class T>
    void operator()(std::vector<T>& values) {
        const std::size_t n = count();
        for (std::size_t i = 0; i < n; ++i) item(values.emplace_back());
    }

  private:
    // Everything has at least one byte.
    std::size_t count() {
        std::uint64_t n = 0;
        (*this)(n);
        if (n > bytes_.size()) throw std::length_error("a count beyond the end");
        return static_cast<std::size_t>(n);
    }
    template <class T>
    void raw(T* values, std::size_t n) {
        if (n * sizeof(T) > bytes_.size()) throw std::length_error("the end came early");
        std::memcpy(values, bytes_.data(), n * sizeof(T));
        bytes_.remove_prefix(n * sizeof(T));
    }
    template <class T>
    void item(T& value);

    std::string_view bytes_;
};

template <class T>
constexpr bool has_no_members =
    std::is_arithmetic_v<T> || std::is_same_v<T, Vec3> || std::is_same_v<T, std::string>;

template <class V, class... T>
void visit_all(V& visit, T&... values) {
    (visit(values), ...);
}

template <class V, class T>
requires std::same_as<std::remove_const_t<T>, Transform>
void members(V& visit, T& t) {
    visit_all(visit, t.x, t.y, t.z, t.origin);
}

template <class V, class T>
requires std::same_as<std::remove_const_t<T>, ImportedMaterial>
void members(V& visit, T& m) {
    visit_all(visit, m.name, m.diffuse, m.emissive, m.opacity, m.refractive_index, m.two_sided,
              m.diffuse_known, m.diffuse_texture, m.emissive_texture);
}

template <class V, class T>
requires std::same_as<std::remove_const_t<T>, ImportedMesh>
void members(V& visit, T& m) {
    visit_all(visit, m.name, m.material, m.positions, m.normals, m.face_corners, m.corners);
}

template <class V, class T>
requires std::same_as<std::remove_const_t<T>, ImportedNode>
void members(V& visit, T& n) {
    visit(n.name);
    visit(n.parent);
    members(visit, n.placing);
    visit(n.meshes);
}

template <class V, class T>
requires std::same_as<std::remove_const_t<T>, ImportedCamera>
void members(V& visit, T& c) {
    visit_all(visit, c.name, c.position, c.view, c.up, c.fov_x, c.aspect, c.near, c.far);
}

template <class V, class T>
requires std::same_as<std::remove_const_t<T>, ImportedLight>
void members(V& visit, T& l) {
    visit_all(visit, l.name, l.kind, l.position, l.direction, l.colour, l.inner_cone, l.outer_cone);
}

template <class V, class T>
requires std::same_as<std::remove_const_t<T>, ImportedScene>
void members(V& visit, T& s) {
    visit_all(visit, s.nodes, s.meshes, s.materials, s.cameras, s.lights, s.warnings, s.missing,
              s.refused, s.unit, s.up_axis, s.up_sign);
}

template <class T>
void Packer::item(const T& value) {
    if constexpr (has_no_members<T>)
        (*this)(value);
    else
        members(*this, value);
}

template <class T>
void Unpacker::item(T& value) {
    if constexpr (has_no_members<T>)
        (*this)(value);
    else
        members(*this, value);
}

}  // namespace

std::string pack(const ImportedScene& scene) {
    Packer packer;
    members(packer, scene);
    return packer.take();
}

ImportedScene unpack(std::string_view bytes) {
    Unpacker unpacker(bytes);
    ImportedScene out;
    members(unpacker, out);
    if (!unpacker.ended()) throw std::length_error("there is more than was expected");
    return out;
}

}  // namespace exitance
