// gltf_tinygltf.cpp - a document that gltf_guard.c let through, parsed by tinygltf, as the arrays of gltf.h.
extern "C" {
#include "mocap/gltf.h"
#include "runtime/core/base/fail.h"
}

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE
#define TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE
#include <tiny_gltf.h>

#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <string>

namespace
{
// ------------------------------------------------------------------------------------- the only "files" there are
struct Shelf {
    const ff_gltf_buffer *buffers;
    int count;
};

// The guard has renamed every buffer that is no data URI to its number.
const ff_gltf_buffer *find(const std::string &name, void *user)
{
    const Shelf *shelf = static_cast<const Shelf *>(user);
    char *end = nullptr;
    unsigned long index = std::strtoul(name.c_str(), &end, 10);
    bool number = !name.empty() && *end == '\0' && index < static_cast<unsigned long>(shelf->count);
    return number && shelf->buffers[index].data ? &shelf->buffers[index] : nullptr;
}

bool exists(const std::string &name, void *user)
{
    return find(name, user) != nullptr;
}

std::string same(const std::string &name, void *)
{
    return name;
}

bool read_whole(std::vector<unsigned char> *out, std::string *, const std::string &name, void *user)
{
    const ff_gltf_buffer *buffer = find(name, user);
    if (buffer) out->assign(buffer->data, buffer->data + buffer->size);
    return buffer != nullptr;
}

bool write_nothing(std::string *, const std::string &, const std::vector<unsigned char> &, void *)
{
    return false;
}

// ----------------------------------------------------------------------------------------------- model to arrays
template <typename Item>
Item *make(size_t count)
{
    void *items = std::calloc(count ? count : 1, sizeof(Item));
    if (!items) throw std::bad_alloc();
    return static_cast<Item *>(items);
}

template <typename Item>
int size_of(const std::vector<Item> &items)
{
    return static_cast<int>(items.size());
}

void name(char *to, const std::string &from)
{
    size_t length = from.size() < 63 ? from.size() : 63;
    std::memcpy(to, from.data(), length);
    to[length] = '\0';
}

// The guard leaves an element's number in the file as its name when it has moved.
int number_of(const std::string &name, int index)
{
    return name.empty() ? index : std::atoi(name.c_str());
}

void numbers(double *to, const std::vector<double> &from, std::initializer_list<double> otherwise)
{
    if (from.size() == otherwise.size()) {
        std::copy(from.begin(), from.end(), to);
    } else {
        std::copy(otherwise.begin(), otherwise.end(), to);
    }
}

void take_nodes(const tinygltf::Model &m, ff_gltf *out)
{
    out->nodes = make<ff_gltf_node>(m.nodes.size());
    out->order = make<int>(m.nodes.size());
    out->node_count = size_of(m.nodes);
    for (int i = 0; i < out->node_count; ++i)
        out->nodes[i].parent = -1;
    for (int i = 0; i < out->node_count; ++i) {
        const tinygltf::Node &from = m.nodes[static_cast<size_t>(i)];
        ff_gltf_node &to = out->nodes[i];
        name(to.name, from.name);
        to.mesh = from.mesh;
        to.skin = from.skin;
        to.has_matrix = from.matrix.size() == 16;
        numbers(to.matrix, from.matrix, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        numbers(to.translation, from.translation, {0, 0, 0});
        numbers(to.rotation, from.rotation, {0, 0, 0, 1});
        numbers(to.scale, from.scale, {1, 1, 1});
        for (int child : from.children) {
            if (child >= out->node_count)
                throw std::string("nodes[" + std::to_string(i) + "].children: no such node");
            if (out->nodes[child].parent >= 0 || child == i)
                throw std::string("nodes[" + std::to_string(child) + "] has two parents");
            out->nodes[child].parent = i;
        }
    }
}

void take_buffers(const tinygltf::Model &m, ff_gltf *out)
{
    out->buffers = make<ff_gltf_buffer>(m.buffers.size());
    out->buffer_count = size_of(m.buffers);
    for (int i = 0; i < out->buffer_count; ++i) {
        const std::vector<unsigned char> &data = m.buffers[static_cast<size_t>(i)].data;
        out->buffers[i] = {data.data(), data.size()};
    }
    out->views = make<ff_gltf_view>(m.bufferViews.size());
    out->view_count = size_of(m.bufferViews);
    for (int i = 0; i < out->view_count; ++i) {
        const tinygltf::BufferView &from = m.bufferViews[static_cast<size_t>(i)];
        out->views[i] = {from.buffer, from.byteOffset, from.byteLength, from.byteStride,
                         number_of(from.name, i)};
    }
}

void take_accessors(const tinygltf::Model &m, ff_gltf *out)
{
    out->accessors = make<ff_gltf_accessor>(m.accessors.size());
    out->accessor_count = size_of(m.accessors);
    for (int i = 0; i < out->accessor_count; ++i) {
        const tinygltf::Accessor &from = m.accessors[static_cast<size_t>(i)];
        ff_gltf_accessor &to = out->accessors[i];
        to.at = {from.bufferView, from.byteOffset, from.componentType};
        to.width = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(from.type));
        to.count = from.count;
        to.normalised = from.normalized;
        to.number = number_of(from.name, i);
        if (!from.sparse.isSparse) continue;
        to.sparse_count = static_cast<size_t>(from.sparse.count);
        to.sparse_indices = {from.sparse.indices.bufferView,
                             static_cast<size_t>(from.sparse.indices.byteOffset),
                             from.sparse.indices.componentType};
        to.sparse_values = {from.sparse.values.bufferView, static_cast<size_t>(from.sparse.values.byteOffset),
                            from.componentType};
    }
}

ff_gltf_path path_of(const std::string &text)
{
    if (text == "translation") return FF_GLTF_TRANSLATION;
    if (text == "rotation") return FF_GLTF_ROTATION;
    return text == "scale" ? FF_GLTF_SCALE : FF_GLTF_OTHER;
}

void take_channel(const tinygltf::Animation &animation, const tinygltf::AnimationChannel &from, int index,
                  ff_gltf_channel &to)
{
    if (from.sampler < 0 || from.sampler >= size_of(animation.samplers))
        throw std::string("animations[" + std::to_string(index) + "].channels: no sampler " +
                          std::to_string(from.sampler));
    const tinygltf::AnimationSampler &sampler = animation.samplers[static_cast<size_t>(from.sampler)];
    to.node = from.target_node;
    to.path = path_of(from.target_path);
    to.input = sampler.input;
    to.output = sampler.output;
    to.interpolation = sampler.interpolation == "STEP"          ? FF_GLTF_STEP
                       : sampler.interpolation == "CUBICSPLINE" ? FF_GLTF_CUBICSPLINE
                                                                : FF_GLTF_LINEAR;
    bool known = sampler.interpolation.empty() || sampler.interpolation == "LINEAR" ||
                 to.interpolation != FF_GLTF_LINEAR;
    if (!known)
        throw std::string("animations[" + std::to_string(index) + "].samplers[" +
                          std::to_string(from.sampler) +
                          "].interpolation: expected STEP, LINEAR or CUBICSPLINE");
}

void take_animations(const tinygltf::Model &m, ff_gltf *out)
{
    size_t count = 0;
    for (const tinygltf::Animation &animation : m.animations)
        count += animation.channels.size();
    out->animations = make<ff_gltf_animation>(m.animations.size());
    out->channels = make<ff_gltf_channel>(count);
    for (const tinygltf::Animation &from : m.animations) {
        ff_gltf_animation &to = out->animations[out->animation_count];
        name(to.name, from.name);
        to.first_channel = out->channel_count;
        to.channel_count = size_of(from.channels);
        for (const tinygltf::AnimationChannel &channel : from.channels)
            take_channel(from, channel, out->animation_count, out->channels[out->channel_count++]);
        ++out->animation_count;
    }
}

void take_skins(const tinygltf::Model &m, ff_gltf *out)
{
    size_t count = 0;
    for (const tinygltf::Skin &skin : m.skins)
        count += skin.joints.size();
    out->skins = make<ff_gltf_skin>(m.skins.size());
    out->skin_joints = make<int>(count);
    for (const tinygltf::Skin &from : m.skins) {
        ff_gltf_skin &to = out->skins[out->skin_count++];
        name(to.name, from.name);
        to.first_joint = out->skin_joint_count;
        to.joint_count = size_of(from.joints);
        to.inverse_bind = from.inverseBindMatrices;
        for (int joint : from.joints)
            out->skin_joints[out->skin_joint_count++] = joint;
    }
}

int attribute(const tinygltf::Primitive &primitive, const char *key)
{
    auto found = primitive.attributes.find(key);
    return found == primitive.attributes.end() ? -1 : found->second;
}

void take_meshes(const tinygltf::Model &m, ff_gltf *out)
{
    size_t count = 0;
    for (const tinygltf::Mesh &mesh : m.meshes)
        count += mesh.primitives.size();
    out->meshes = make<ff_gltf_mesh>(m.meshes.size());
    out->primitives = make<ff_gltf_primitive>(count);
    for (const tinygltf::Mesh &from : m.meshes) {
        ff_gltf_mesh &to = out->meshes[out->mesh_count++];
        name(to.name, from.name);
        to.first_primitive = out->primitive_count;
        to.primitive_count = size_of(from.primitives);
        for (const tinygltf::Primitive &p : from.primitives)
            out->primitives[out->primitive_count++] = {p.mode,
                                                       p.indices,
                                                       attribute(p, "POSITION"),
                                                       attribute(p, "NORMAL"),
                                                       attribute(p, "TEXCOORD_0"),
                                                       attribute(p, "JOINTS_0"),
                                                       attribute(p, "WEIGHTS_0"),
                                                       attribute(p, "JOINTS_1") >= 0};
    }
}
} // namespace

extern "C" {

ff_status ff_gltf_adapt(const char *json, const ff_gltf_buffer *buffers, int buffer_count, ff_gltf *out,
                        ff_error *error)
{
    try {
        std::unique_ptr<tinygltf::Model> model(new tinygltf::Model);
        Shelf shelf = {buffers, buffer_count};
        tinygltf::TinyGLTF loader;
        loader.SetFsCallbacks({exists, same, read_whole, write_nothing, &shelf});
        std::string problem, warning;
        if (!loader.LoadASCIIFromString(model.get(), &problem, &warning, json,
                                        static_cast<unsigned int>(std::strlen(json)), ""))
            return ff_fail(error, FF_ERR_PARSE, "%.200s", problem.substr(0, problem.find('\n')).c_str());
        take_nodes(*model, out);
        take_buffers(*model, out);
        take_accessors(*model, out);
        take_animations(*model, out);
        take_skins(*model, out);
        take_meshes(*model, out);
        out->model = model.release();
        return FF_OK;
    } catch (const std::string &problem) {
        return ff_fail(error, FF_ERR_PARSE, "%.300s", problem.c_str());
    } catch (const std::bad_alloc &) {
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory for the document");
    } catch (...) {
        return ff_fail(error, FF_ERR_PARSE, "tinygltf could not read the document");
    }
}

void ff_gltf_release_model(void *model)
{
    delete static_cast<tinygltf::Model *>(model);
}
}
