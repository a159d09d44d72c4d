// mesh_openmesh.cpp - ff_mesh_collapse of mesh.h on OpenMesh.
extern "C" {
#include "preprocess/skin/mesh.h"
#include "runtime/core/base/fail.h"
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wextra"
#ifndef __clang__ // points are made without a value and then given one, which gcc takes for a fault when it inlines
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#pragma GCC diagnostic pop

#include <cstdint>
#include <cstdlib>
#include <new>
#include <vector>

namespace
{
struct Traits : OpenMesh::DefaultTraits {
    typedef OpenMesh::Vec3d Point;
    typedef OpenMesh::Vec3d Normal;
};
typedef OpenMesh::TriMesh_ArrayKernelT<Traits> Mesh;

template <typename Item>
Item *make(size_t count)
{
    void *items = std::calloc(count ? count : 1, sizeof(Item));
    if (!items) throw std::bad_alloc();
    return static_cast<Item *>(items);
}

// The triangle on vertices of its own, when the mesh has no room for it between those it names: an edge of three.
void add_triangle(Mesh &mesh, std::vector<int> &origin, const uint32_t corners[3], int *torn)
{
    std::vector<Mesh::VertexHandle> face;
    for (int c = 0; c < 3; ++c)
        face.push_back(Mesh::VertexHandle(static_cast<int>(corners[c])));
    if (mesh.add_face(face).is_valid()) return;
    ++*torn;
    for (int c = 0; c < 3; ++c) {
        const Mesh::Point at =
            mesh.point(Mesh::VertexHandle(static_cast<int>(corners[c]))); // the mesh may move
        face[static_cast<size_t>(c)] = mesh.add_vertex(at);
        origin.push_back(static_cast<int>(corners[c]));
    }
    mesh.add_face(face);
}

void collapse(Mesh &mesh, int wanted)
{
    mesh.request_face_normals();
    mesh.update_face_normals();
    OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
    OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
    decimater.add(quadric);
    decimater.add(flipping);
    decimater.module(quadric).unset_max_err();
    if (!decimater.initialize()) return;
    decimater.decimate_to_faces(0, static_cast<size_t>(wanted));
}
} // namespace

extern "C" ff_status ff_mesh_collapse(const ff_vec3 *places, int count, const uint32_t (*triangles)[3],
                                      int triangle_count, int wanted, int **kept, int *kept_count,
                                      uint32_t (**faces)[3], int *face_count, int *torn, ff_error *error)
{
    *kept = nullptr;
    *faces = nullptr;
    *kept_count = *face_count = 0;
    try {
        omerr().disable(); // edges of three triangles are counted, not told about one by one
        Mesh mesh;
        std::vector<int> origin;
        mesh.request_vertex_status();
        mesh.request_edge_status();
        mesh.request_halfedge_status();
        mesh.request_face_status();
        for (int i = 0; i < count; ++i) {
            mesh.add_vertex(Mesh::Point(places[i].x, places[i].y, places[i].z));
            origin.push_back(i);
        }
        for (int t = 0; t < triangle_count; ++t)
            add_triangle(mesh, origin, triangles[t], torn);
        if (wanted < triangle_count) collapse(mesh, wanted);

        std::vector<int> renumbered(mesh.n_vertices(), -1);
        *kept = make<int>(mesh.n_vertices());
        *faces = reinterpret_cast<uint32_t(*)[3]>(make<uint32_t>(3 * mesh.n_faces()));
        for (size_t f = 0; f < mesh.n_faces(); ++f) {
            Mesh::FaceHandle face(static_cast<int>(f));
            if (mesh.status(face).deleted()) continue;
            int corner = 0;
            for (Mesh::ConstFaceVertexIter v = mesh.cfv_iter(face); v.is_valid() && corner < 3; ++v) {
                int &number = renumbered[static_cast<size_t>(v->idx())];
                if (number < 0) {
                    number = *kept_count;
                    (*kept)[(*kept_count)++] = origin[static_cast<size_t>(v->idx())];
                }
                (*faces)[*face_count][corner++] = static_cast<uint32_t>(number);
            }
            ++*face_count;
        }
        return FF_OK;
    } catch (...) {
        std::free(*kept);
        std::free(*faces);
        *kept = nullptr;
        *faces = nullptr;
        return ff_fail(error, FF_ERR_NO_MEMORY, "no memory to simplify %d triangles", triangle_count);
    }
}
