// SPDX-License-Identifier: Apache-2.0
// The one file that knows Assimp.
#include "exitance/scene/formats/assimp_import.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>
#include <utility>

#include "exitance/scene/formats/include_files.h"

namespace exitance {

namespace {

constexpr std::size_t most_messages = 20;

// The scene's bytes under one name, and files of its folder.
class SceneFolder : public Assimp::IOSystem {
  public:
    SceneFolder(std::string name, const std::string& bytes, const std::filesystem::path& path,
                const ReadOptions& options, ImportedScene& out)
        : name_(std::move(name)),
          bytes_(bytes),
          files_(path, "", options),
          place_{path.string(), 0, 0},
          out_(out) {}

    bool Exists(const char* file) const override { return text_of(file) != nullptr; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (mode == nullptr || mode[0] != 'r') return nullptr;
        const std::string* text = text_of(file);
        if (text == nullptr) return nullptr;
        return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(text->data()),
                                          text->size());
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

  private:
    const std::string* text_of(std::string name) const {
        while (name.starts_with("./")) name.erase(0, 2);
        if (name == name_) return &bytes_;
        std::replace(name.begin(), name.end(), '\\', '/');
        const auto known = known_.find(name);
        if (known != known_.end()) return known->second ? &known->second->text : nullptr;
        auto& file = known_[name];
        try {
            std::error_code ignored;
            if (!std::filesystem::exists(files_.resolve(name, place_), ignored)) {
                out_.missing.push_back(name);
                return nullptr;
            }
            file = files_.enter(name, place_);
            files_.leave();
        } catch (const Error& error) {
            if (out_.refused.empty()) out_.refused = error.what();
            return nullptr;
        }
        return &file->text;
    }

    std::string name_;
    const std::string& bytes_;
    mutable IncludeFiles files_;
    Place place_;
    ImportedScene& out_;
    mutable std::map<std::string, std::shared_ptr<const SourceFile>> known_;
};

class Messages : public Assimp::LogStream {
  public:
    explicit Messages(std::vector<std::string>& out) : out_(out) {}
    void write(const char* message) override {
        std::string text(message);
        while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
        // "Warn,  T0: what"
        const std::size_t colon = text.find(": ");
        if (colon != std::string::npos && colon < 12) text.erase(0, colon + 2);
        if (out_.size() < most_messages && std::find(out_.begin(), out_.end(), text) == out_.end())
            out_.push_back(text);
    }

  private:
    std::vector<std::string>& out_;
};

Vec3 vector_of(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

std::array<double, 3> colour_of(const aiColor3D& c) {
    return {c.r, c.g, c.b};
}

Transform transform_of(const aiMatrix4x4& m) {
    return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

ImportedMaterial material_of(const aiMaterial& from) {
    ImportedMaterial to;
    to.name = from.GetName().C_Str();
    aiColor3D colour;
    if (from.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS) {
        to.diffuse = colour_of(colour);
        to.diffuse_known = true;
    }
    if (from.Get(AI_MATKEY_COLOR_EMISSIVE, colour) == aiReturn_SUCCESS)
        to.emissive = colour_of(colour);
    ai_real number = 0;
    if (from.Get(AI_MATKEY_OPACITY, number) == aiReturn_SUCCESS) to.opacity = number;
    if (from.Get(AI_MATKEY_REFRACTI, number) == aiReturn_SUCCESS && number > 1)
        to.refractive_index = number;
    int flag = 0;
    if (from.Get(AI_MATKEY_TWOSIDED, flag) == aiReturn_SUCCESS) to.two_sided = flag != 0;
    to.diffuse_texture = from.GetTextureCount(aiTextureType_DIFFUSE) > 0 ||
                         from.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
    to.emissive_texture = from.GetTextureCount(aiTextureType_EMISSIVE) > 0;
    return to;
}

ImportedMesh mesh_of(const aiMesh& from, std::size_t& left_out) {
    ImportedMesh to;
    to.name = from.mName.C_Str();
    to.material = from.mMaterialIndex;
    to.positions.reserve(from.mNumVertices);
    for (unsigned i = 0; i < from.mNumVertices && from.mVertices != nullptr; ++i)
        to.positions.push_back(vector_of(from.mVertices[i]));
    for (unsigned i = 0; i < from.mNumVertices && from.mNormals != nullptr; ++i)
        to.normals.push_back(vector_of(from.mNormals[i]));
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
        const aiFace& face = from.mFaces[f];
        if (face.mNumIndices < 3) {
            ++left_out;
            continue;
        }
        to.face_corners.push_back(face.mNumIndices);
        to.corners.insert(to.corners.end(), face.mIndices, face.mIndices + face.mNumIndices);
    }
    return to;
}

std::vector<ImportedNode> nodes_of(const aiNode* root) {
    std::vector<ImportedNode> out;
    std::vector<std::pair<const aiNode*, std::optional<std::uint32_t>>> open{{root, std::nullopt}};
    while (!open.empty()) {
        const auto [node, parent] = open.back();
        open.pop_back();
        if (node == nullptr) continue;
        ImportedNode to;
        to.name = node->mName.C_Str();
        to.parent = parent;
        to.placing = transform_of(node->mTransformation);
        if (node->mNumMeshes > 0) to.meshes.assign(node->mMeshes, node->mMeshes + node->mNumMeshes);
        const auto index = static_cast<std::uint32_t>(out.size());
        out.push_back(std::move(to));
        for (unsigned c = node->mNumChildren; c > 0; --c)
            open.emplace_back(node->mChildren[c - 1], index);
    }
    return out;
}

ImportedCamera camera_of(const aiCamera& from) {
    ImportedCamera to;
    to.name = from.mName.C_Str();
    to.position = vector_of(from.mPosition);
    to.view = vector_of(from.mLookAt);
    to.up = vector_of(from.mUp);
    to.fov_x = from.mHorizontalFOV;
    to.aspect = from.mAspect;
    to.near = from.mClipPlaneNear;
    to.far = from.mClipPlaneFar;
    return to;
}

ImportedLight light_of(const aiLight& from) {
    ImportedLight to;
    to.name = from.mName.C_Str();
    if (from.mType == aiLightSource_POINT) to.kind = ImportedLight::Kind::point;
    if (from.mType == aiLightSource_SPOT) to.kind = ImportedLight::Kind::spot;
    if (from.mType == aiLightSource_DIRECTIONAL) to.kind = ImportedLight::Kind::directional;
    to.position = vector_of(from.mPosition);
    to.direction = vector_of(from.mDirection);
    to.colour = colour_of(from.mColorDiffuse);
    to.inner_cone = from.mAngleInnerCone;
    to.outer_cone = from.mAngleOuterCone;
    return to;
}

void read_metadata(const aiScene& scene, ImportedScene& out) {
    if (scene.mMetaData == nullptr) return;
    const auto axis = [&](const char* name, std::optional<int>& to) {
        std::int32_t value = 0;
        if (scene.mMetaData->Get(name, value)) to = value;
    };
    axis("UpAxis", out.up_axis);
    axis("UpAxisSign", out.up_sign);
    double centimetres = 0;
    float single = 0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres))
        out.unit = centimetres / 100;
    else if (scene.mMetaData->Get("UnitScaleFactor", single))
        out.unit = double{single} / 100;
}

// Assimp tries every importer that it has; one remains.
void keep_only(Assimp::Importer& importer, const std::string& extension) {
    Assimp::BaseImporter* const wanted = importer.GetImporter(extension.c_str());
    for (std::size_t i = importer.GetImporterCount(); i > 0; --i) {
        Assimp::BaseImporter* const other = importer.GetImporter(i - 1);
        if (other != wanted) importer.UnregisterLoader(other);
    }
    if (wanted == nullptr) throw std::runtime_error("this Assimp has no importer for it");
}

}  // namespace

ImportedScene assimp_import(const std::filesystem::path& path, const std::string& extension,
                            const std::string& bytes, const ReadOptions& options) {
    ImportedScene out;
    const std::string name = path.stem().string() + extension;
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Messages(out.warnings),
                                               Assimp::Logger::Warn | Assimp::Logger::Err);
    Assimp::Importer importer;
    keep_only(importer, extension);
    importer.SetIOHandler(new SceneFolder(name, bytes, path, options, out));
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    const aiScene* scene = importer.ReadFile(name, 0);
    Assimp::DefaultLogger::kill();
    if (scene == nullptr) {
        if (!out.refused.empty()) return out;
        const std::string why = importer.GetErrorString();
        if (why.find("std::bad_alloc") != std::string::npos) throw std::bad_alloc();
        throw std::runtime_error(why);
    }
    std::size_t left_out = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; ++i)
        out.meshes.push_back(mesh_of(*scene->mMeshes[i], left_out));
    if (left_out > 0)
        out.warnings.push_back(std::to_string(left_out) + " points or lines are left out");
    for (unsigned i = 0; i < scene->mNumMaterials; ++i)
        out.materials.push_back(material_of(*scene->mMaterials[i]));
    for (unsigned i = 0; i < scene->mNumCameras; ++i)
        out.cameras.push_back(camera_of(*scene->mCameras[i]));
    for (unsigned i = 0; i < scene->mNumLights; ++i)
        out.lights.push_back(light_of(*scene->mLights[i]));
    out.nodes = nodes_of(scene->mRootNode);
    read_metadata(*scene, out);
    return out;
}

}  // namespace exitance
