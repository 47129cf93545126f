// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/radiosity.h"

#include <cmath>

#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"
#include "exitance/scene/texture_map.h"
#include "exitance/solve/distant_flux.h"
#include "exitance/visibility/exposure.h"

namespace exitance {

namespace {

RayCaster make_caster(const Scene& scene) {
    std::vector<RayCaster::Face> faces;
    std::vector<float> transmittance;
    faces.reserve(scene.polygons.size());
    for (const Polygon& p : scene.polygons) {
        faces.push_back({p.corners[0], p.corners[1], p.corners[2],
                         p.size() == 4 ? p.corners[3] : p.corners[2]});
        transmittance.push_back(static_cast<float>(scene.material(p).clear_transmittance()));
    }
    return RayCaster(scene.points, faces, {}, std::move(transmittance));
}

}  // namespace

Columns::Columns(const std::vector<LightGroup>& light_groups, std::size_t band_count)
    : groups(light_groups.size()),
      bands(band_count),
      count(groups * bands),
      stride(padded_columns(count)),
      weight(stride, 0.0f) {
    const Spectrum band_weight = luminance_weights(bands);
    for (std::size_t c = 0; c < count; ++c)
        weight[c] = static_cast<float>(light_groups[c / bands].weight * band_weight[c % bands]);
}

float Columns::luminance(std::span<const float> row) const {
    float sum = 0;
    for (std::size_t c = 0; c < stride; ++c) sum += weight[c] * row[c];
    return sum;
}

float Columns::magnitude(std::span<const float> row) const {
    float sum = 0;
    for (std::size_t c = 0; c < stride; ++c) sum += weight[c] * std::abs(row[c]);
    return sum;
}

Radiosity::Radiosity(const Scene& the_scene, const LightGroups& light_groups,
                     const MeshOptions& mesh_options)
    : scene(the_scene),
      groups(light_groups),
      columns(groups.groups, scene.bands.size()),
      caster(make_caster(scene)),
      owners(scene, caster),
      luminaires(scene.luminaires.begin(), scene.luminaires.end()),
      mesh(scene, mesh_options),
      irradiance(0, columns.count),
      shot(0, columns.count),
      rho_of_element_(0, columns.count) {
    rho_.assign(scene.materials.size() * columns.stride, 0.0f);
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        for (std::size_t c = 0; c < columns.count; ++c)
            rho_[m * columns.stride + c] =
                static_cast<float>(scene.materials[m].reflectance[c % columns.bands]);
    emitted_.assign(scene.surfaces.size() * columns.stride, 0.0f);
    for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
        for (std::size_t b = 0; b < columns.bands; ++b)
            emitted_[s * columns.stride + groups.group_of_surface[s] * columns.bands + b] =
                static_cast<float>(scene.materials[scene.surfaces[s].material].exitance[b]);
    find_emission_of_textured_polygons();
    for (const Material& material : scene.materials)
        any_textured_ = any_textured_ || material.reflectance_pattern;
    emitted_by_luminaire_.assign(luminaires.size() * columns.stride, 0.0f);
    for (std::size_t l = 0; l < luminaires.size(); ++l) {
        for (std::size_t b = 0; b < columns.bands; ++b)
            emitted_by_luminaire_[l * columns.stride +
                                  groups.group_of_luminaire[l] * columns.bands + b] =
                static_cast<float>(scene.luminaires[l].colour[b]);
        emitted_flux_ += scene.luminaires[l].flux() *
                         static_cast<double>(columns.luminance(emitted_by_luminaire(l)));
    }
    emitted_from_afar_.assign(scene.distant.size() * columns.stride, 0.0f);
    for (std::size_t l = 0; l < scene.distant.size(); ++l) {
        const DistantLight& light = scene.distant[l];
        for (std::size_t b = 0; b < columns.bands; ++b)
            emitted_from_afar_[l * columns.stride + groups.group_of_distant[l] * columns.bands +
                               b] = static_cast<float>(light.colour[b]);
        if (light.kind == DistantLight::Kind::sky && light.shines()) skies.emplace_back(l, light);
    }
    for (const Polygon& p : scene.polygons) {
        const Material& material = scene.material(p);
        two_sided_.push_back(material.two_sided);
        black_lamp_.push_back(material.emits() && !(luminance(material.reflectance) > 0));
    }

    for (const Face& face : mesh.faces()) {
        const auto corners = mesh.corners(face);
        const double a = exitance::area({corners.data(), face.count});
        area_ += a;
        emitted_flux_ += a * static_cast<double>(columns.luminance(emitted(face)));
    }
    for (std::size_t l = 0; l < scene.distant.size(); ++l)
        emitted_flux_ +=
            groups.groups[groups.group_of_distant[l]].weight * received_flux(*this, l, 0);
    admit_new_vertices();
}

std::span<const float> Radiosity::emitted_from_afar(std::size_t light) const {
    return {&emitted_from_afar_[light * columns.stride], columns.stride};
}

std::span<const float> Radiosity::rho(const Face& face) const {
    return {&rho_[scene.surfaces[face.surface].material * columns.stride], columns.stride};
}

std::span<const float> Radiosity::rho(ElementId element) const {
    const Face& face = mesh.face_of(mesh[element]);
    return textured(face) ? rho_of_element_[element] : rho(face);
}

std::span<const float> Radiosity::emitted(const Face& face) const {
    std::uint32_t row = face.surface;
    if (!emitted_of_polygon_.empty()) row = emitted_of_polygon_[face.polygon.index()];
    return {&emitted_[row * columns.stride], columns.stride};
}

bool Radiosity::textured(const Face& face) const {
    return any_textured_ &&
           scene.materials[scene.surfaces[face.surface].material].reflectance_pattern;
}

void Radiosity::find_emission_of_textured_polygons() {
    bool any = false;
    for (const Material& material : scene.materials) any = any || material.exitance_pattern;
    if (!any) return;
    for (const Polygon& polygon : scene.polygons) {
        emitted_of_polygon_.push_back(polygon.surface);
        if (!scene.material(polygon).exitance_pattern) continue;
        const Spectrum mean = mean_exitance(scene, polygon);
        const std::size_t group = groups.group_of_surface[polygon.surface];
        emitted_of_polygon_.back() = static_cast<std::uint32_t>(emitted_.size() / columns.stride);
        emitted_.resize(emitted_.size() + columns.stride, 0.0f);
        for (std::size_t b = 0; b < columns.bands; ++b)
            emitted_[emitted_.size() - columns.stride + group * columns.bands + b] =
                static_cast<float>(mean[b]);
    }
}

// An element's outline lies on the texture as its polygon does.
void Radiosity::find_rho_of_new_elements() {
    if (!any_textured_) return;
    const std::size_t first = textured_elements_, count = mesh.elements().size();
    textured_elements_ = count;
    rho_of_element_.resize_rows(count);
    parallel_for(count - first, [&](std::size_t i) {
        const ElementId id(first + i);
        const Element& element = mesh[id];
        const Face& face = mesh.face_of(element);
        if (!textured(face)) return;
        const Polygon& polygon = scene.polygons[face.polygon.index()];
        const TextureMap map = reflectance_map(scene, polygon);
        const auto corners = mesh.corners(element);
        std::array<TexturePoint, 4> outline;
        for (std::uint32_t c = 0; c < element.count; ++c) outline[c] = map(corners[c]);
        const Vec3 mean =
            scene.material(polygon).reflectance_pattern.mean({outline.data(), element.count});
        const auto row = rho_of_element_[id];
        for (std::size_t c = 0; c < columns.count; ++c)
            row[c] = static_cast<float>(mean[c % columns.bands]);
    });
}

std::span<const float> Radiosity::emitted_by_luminaire(std::size_t luminaire) const {
    return {&emitted_by_luminaire_[luminaire * columns.stride], columns.stride};
}

bool Radiosity::emits(const Face& face) const {
    if (!scene.materials[scene.surfaces[face.surface].material].emits()) return false;
    if (emitted_of_polygon_.empty()) return true;
    return columns.magnitude(emitted(face)) > 0;
}

void Radiosity::admit_new_vertices() {
    const std::size_t first = receivers.size(), count = mesh.vertices().size();
    for (std::size_t v = first; v < count; ++v) {
        const Vertex& vertex = mesh.vertices()[v];
        receivers.add(vertex.sample - caster.middle(), Vec3(vertex.normal),
                      static_cast<std::uint32_t>(v));
    }
    exposed.resize(count);
    find_exposed(caster, two_sided_, receivers, first, std::span(exposed).subspan(first));
    sends.resize(count);
    parallel_for(count - first, [&](std::size_t i) {
        const Vertex& vertex = mesh.vertices()[first + i];
        const Face& face = mesh[vertex.face];
        sends[first + i] = exposed[first + i] &&
                           owners.owns(face.polygon, face.back, vertex.sample - caster.middle());
    });
    irradiance.resize_rows(count);
    seen.resize(count, 1.0f);
    variance.resize(count, 0.0f);
    shot.resize_rows(mesh.elements().size());
    find_rho_of_new_elements();
}

void Radiosity::receive(VertexId vertex, std::span<const float> row) {
    const auto H = irradiance[vertex];
    for (std::size_t c = 0; c < columns.stride; ++c) H[c] += row[c];
}

float Radiosity::open_share(const Element& element) const {
    float open = 0;
    for (const VertexId v : element.corners())
        if (sends[v.index()]) ++open;
    return open / static_cast<float>(element.count);
}

void Radiosity::mean_weights(ElementId leaf, std::vector<Weight>& out) const {
    out.clear();
    const Element& element = mesh[leaf];
    const float open = open_share(element) * static_cast<float>(element.count);
    if (open == 0) return;
    for (const VertexId v : element.corners())
        if (sends[v.index()]) out.push_back({v, 1.0f / open});
    if (!element.parent.valid()) return;

    const Element& parent = mesh[element.parent];
    const auto corner = 1.0f / static_cast<float>(parent.count);
    bool whole = open_share(parent) == 1.0f;
    for (std::size_t c = 0; c < 4; ++c) {
        const Element& child = mesh[ElementId(parent.first_child.index() + c)];
        whole = whole && child.leaf() && open_share(child) == 1.0f;
    }
    if (!whole) return;
    // (4 T(h/2) − T(h)) / 3 exceeds T(h/2) by (T(h/2) − T(h)) / 3, spread over the four.
    for (std::size_t c = 0; c < 4; ++c) {
        const Element& child = mesh[ElementId(parent.first_child.index() + c)];
        for (const VertexId v : child.corners())
            out.push_back({v, child.area / parent.area * corner / 3.0f});
    }
    for (const VertexId v : parent.corners()) out.push_back({v, -corner / 3.0f});
}

void Radiosity::mean_irradiance(ElementId leaf, std::span<float> out) const {
    std::vector<Weight> weights;
    mean_weights(leaf, weights);
    std::fill(out.begin(), out.end(), 0.0f);
    for (const Weight& w : weights) {
        const auto H = irradiance[w.vertex];
        for (std::size_t c = 0; c < columns.stride; ++c) out[c] += w.share * H[c];
    }
}

void Radiosity::reflected_exitance(ElementId leaf, std::span<float> out) const {
    mean_irradiance(leaf, out);
    const auto reflectance = rho(leaf);
    for (std::size_t c = 0; c < columns.stride; ++c) out[c] *= reflectance[c];
}

Source Radiosity::source(const Face& face, const std::array<Vec3, 4>& corners) const {
    Source out(corners, face.count, caster.middle());
    out.covers = owners.covers(face.polygon, face.back);
    return out;
}

std::size_t Radiosity::bytes() const {
    return mesh.bytes() + receivers.bytes() + exposed.capacity() + irradiance.bytes() +
           (seen.capacity() + variance.capacity()) * sizeof(float) + sends.capacity() +
           shot.bytes() + rho_of_element_.bytes();
}

}  // namespace exitance
