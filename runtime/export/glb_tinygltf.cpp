// glb_tinygltf.cpp - glb_model.h on tinygltf.
#include "runtime/export/glb_model.h"

extern "C" {
#include "runtime/core/base/fail.h"
}

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>

struct ff_glb_model {
    tinygltf::Model model;
    bool failed = false;
};

namespace
{
// Run a piece of building; -1 and a marked model when memory is short.
template <typename Build>
int built(ff_glb_model *model, Build build) noexcept
{
    try {
        return model->failed ? -1 : build(model->model);
    } catch (...) {
        model->failed = true;
        return -1;
    }
}

template <typename Item>
int last(const std::vector<Item> &items)
{
    return static_cast<int>(items.size()) - 1;
}

int component_type(ff_glb_component component)
{
    switch (component) {
    case FF_GLB_U8:
        return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case FF_GLB_I16:
        return TINYGLTF_COMPONENT_TYPE_SHORT;
    case FF_GLB_U16:
        return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case FF_GLB_U32:
        return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    default:
        return TINYGLTF_COMPONENT_TYPE_FLOAT;
    }
}

int element_type(int width)
{
    switch (width) {
    case 1:
        return TINYGLTF_TYPE_SCALAR;
    case 3:
        return TINYGLTF_TYPE_VEC3;
    case 4:
        return TINYGLTF_TYPE_VEC4;
    default:
        return TINYGLTF_TYPE_MAT4;
    }
}

void place(tinygltf::Node &node, ff_vec3 translation)
{
    if (translation.x != 0.0 || translation.y != 0.0 || translation.z != 0.0)
        node.translation = {translation.x, translation.y, translation.z};
}
} // namespace

extern "C" {

ff_glb_model *ff_glb_model_create(const char *generator)
{
    ff_glb_model *model = new (std::nothrow) ff_glb_model;
    if (!model) return nullptr;
    built(model, [&](tinygltf::Model &m) {
        m.asset.version = "2.0";
        m.asset.generator = generator;
        m.buffers.emplace_back();
        m.scenes.emplace_back();
        m.defaultScene = 0;
        return 0;
    });
    return model;
}

void ff_glb_model_destroy(ff_glb_model *model)
{
    delete model;
}

int ff_glb_add_view(ff_glb_model *model, const void *data, size_t size, size_t stride, ff_glb_use use)
{
    return built(model, [&](tinygltf::Model &m) {
        std::vector<unsigned char> &buffer = m.buffers[0].data;
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = buffer.size();
        view.byteLength = size;
        view.byteStride = stride;
        view.target = use == FF_GLB_VERTICES  ? TINYGLTF_TARGET_ARRAY_BUFFER
                      : use == FF_GLB_INDICES ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER
                                              : 0;
        const unsigned char *bytes = static_cast<const unsigned char *>(data);
        buffer.insert(buffer.end(), bytes, bytes + size);
        buffer.resize((buffer.size() + 3) & ~static_cast<size_t>(3));
        m.bufferViews.push_back(view);
        return last(m.bufferViews);
    });
}

int ff_glb_add_accessor(ff_glb_model *model, int view, size_t offset, ff_glb_component component,
                        int normalised, int width, size_t count, const double *low, const double *high)
{
    return built(model, [&](tinygltf::Model &m) {
        tinygltf::Accessor accessor;
        accessor.bufferView = view;
        accessor.byteOffset = offset;
        accessor.componentType = component_type(component);
        accessor.normalized = normalised != 0;
        accessor.type = element_type(width);
        accessor.count = count;
        if (low && high) {
            accessor.minValues.assign(low, low + width);
            accessor.maxValues.assign(high, high + width);
        }
        m.accessors.push_back(accessor);
        return last(m.accessors);
    });
}

int ff_glb_add_material(ff_glb_model *model, const char *name, const double linear_rgb[3], double roughness,
                        int both_sides)
{
    return built(model, [&](tinygltf::Model &m) {
        tinygltf::Material material;
        material.name = name;
        material.doubleSided = both_sides != 0;
        material.pbrMetallicRoughness.baseColorFactor = {linear_rgb[0], linear_rgb[1], linear_rgb[2], 1.0};
        material.pbrMetallicRoughness.metallicFactor = 0.0;
        material.pbrMetallicRoughness.roughnessFactor = roughness;
        m.materials.push_back(material);
        return last(m.materials);
    });
}

int ff_glb_add_mesh(ff_glb_model *model, const char *name, const ff_glb_primitive *primitives, int count)
{
    return built(model, [&](tinygltf::Model &m) {
        tinygltf::Mesh mesh;
        mesh.name = name;
        for (int i = 0; i < count; ++i) {
            tinygltf::Primitive primitive;
            primitive.mode = TINYGLTF_MODE_TRIANGLES;
            primitive.indices = primitives[i].indices;
            primitive.material = primitives[i].material;
            primitive.attributes["POSITION"] = primitives[i].positions;
            primitive.attributes["NORMAL"] = primitives[i].normals;
            if (primitives[i].joints >= 0) primitive.attributes["JOINTS_0"] = primitives[i].joints;
            if (primitives[i].weights >= 0) primitive.attributes["WEIGHTS_0"] = primitives[i].weights;
            mesh.primitives.push_back(primitive);
        }
        m.meshes.push_back(mesh);
        return last(m.meshes);
    });
}

int ff_glb_add_node(ff_glb_model *model, const char *name, int parent, ff_vec3 translation)
{
    return built(model, [&](tinygltf::Model &m) {
        tinygltf::Node node;
        node.name = name;
        place(node, translation);
        m.nodes.push_back(node);
        std::vector<int> &siblings =
            parent < 0 ? m.scenes[0].nodes : m.nodes[static_cast<size_t>(parent)].children;
        siblings.push_back(last(m.nodes));
        return last(m.nodes);
    });
}

void ff_glb_set_translation(ff_glb_model *model, int node, ff_vec3 translation)
{
    built(model, [&](tinygltf::Model &m) {
        place(m.nodes[static_cast<size_t>(node)], translation);
        return 0;
    });
}

void ff_glb_set_rotation(ff_glb_model *model, int node, ff_quat rotation)
{
    built(model, [&](tinygltf::Model &m) {
        m.nodes[static_cast<size_t>(node)].rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
        return 0;
    });
}

void ff_glb_set_scale(ff_glb_model *model, int node, double scale)
{
    if (scale == 1.0) return;
    built(model, [&](tinygltf::Model &m) {
        m.nodes[static_cast<size_t>(node)].scale = {scale, scale, scale};
        return 0;
    });
}

void ff_glb_set_mesh(ff_glb_model *model, int node, int mesh, int skin)
{
    built(model, [&](tinygltf::Model &m) {
        m.nodes[static_cast<size_t>(node)].mesh = mesh;
        m.nodes[static_cast<size_t>(node)].skin = skin;
        return 0;
    });
}

int ff_glb_add_skin(ff_glb_model *model, const char *name, const int *joints, int count, int inverse_binds)
{
    return built(model, [&](tinygltf::Model &m) {
        tinygltf::Skin skin;
        skin.name = name;
        skin.inverseBindMatrices = inverse_binds;
        skin.joints.assign(joints, joints + count);
        m.skins.push_back(skin);
        return last(m.skins);
    });
}

int ff_glb_add_animation(ff_glb_model *model, const char *name)
{
    return built(model, [&](tinygltf::Model &m) {
        m.animations.emplace_back();
        m.animations.back().name = name;
        return last(m.animations);
    });
}

void ff_glb_add_channel(ff_glb_model *model, int animation, int node, ff_glb_path path, int times, int values,
                        int stepped)
{
    static const char *const names[] = {"translation", "rotation", "scale"};
    built(model, [&](tinygltf::Model &m) {
        tinygltf::Animation &target = m.animations[static_cast<size_t>(animation)];
        tinygltf::AnimationSampler sampler;
        sampler.input = times;
        sampler.output = values;
        sampler.interpolation = stepped ? "STEP" : "LINEAR";
        target.samplers.push_back(sampler);
        tinygltf::AnimationChannel channel;
        channel.sampler = last(target.samplers);
        channel.target_node = node;
        channel.target_path = names[path];
        target.channels.push_back(channel);
        return 0;
    });
}

ff_status ff_glb_model_serialise(ff_glb_model *model, char **bytes, size_t *size, ff_error *error)
{
    *bytes = nullptr;
    *size = 0;
    try {
        if (model->failed) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the glTF document");
        std::ostringstream stream(std::ios::binary);
        tinygltf::TinyGLTF writer;
        if (!writer.WriteGltfSceneToStream(&model->model, stream, false, true))
            return ff_fail(error, FF_ERR_IO, "tinygltf could not write the document");
        const std::string text = stream.str();
        char *copy = static_cast<char *>(std::malloc(text.size() ? text.size() : 1));
        if (!copy) return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the glTF document");
        std::memcpy(copy, text.data(), text.size());
        *bytes = copy;
        *size = text.size();
        return FF_OK;
    } catch (...) {
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the glTF document");
    }
}
}
