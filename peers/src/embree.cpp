// Segments against triangles by Embree's robust mode: reads both from a file, prints the median time of a segment of each set in ns.

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <pmmintrin.h>
#include <vector>
#include <xmmintrin.h>

// How long this thread has been on a processor, in s.
static double on_cpu() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

template <class T> static bool read(FILE *file, T *to, size_t count) { return fread(to, sizeof(T), count, file) == count; }

static size_t intersect(RTCScene scene, const std::vector<float> &segments) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    size_t hits = 0;
    for (size_t i = 0; i < segments.size(); i += 6) {
        RTCRayHit query = {};
        query.ray.org_x = segments[i], query.ray.org_y = segments[i + 1], query.ray.org_z = segments[i + 2];
        query.ray.dir_x = segments[i + 3], query.ray.dir_y = segments[i + 4], query.ray.dir_z = segments[i + 5];
        query.ray.tfar = 1, query.ray.mask = ~0u;
        query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &query);
        hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

int main(int count, char **arguments) {
    // As its documentation asks.
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    FILE *file = count == 2 ? fopen(arguments[1], "rb") : nullptr;
    uint64_t numbers[4];
    if (!file || !read(file, numbers, 4)) return 1;
    const auto [vertices, faces, sets, runs] = numbers;
    std::vector<uint64_t> sizes(sets);
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto *points = static_cast<float *>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices));
    auto *corners = static_cast<unsigned *>(rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, faces));
    if (!read(file, sizes.data(), sets) || !read(file, points, 3 * vertices) || !read(file, corners, 3 * faces)) return 1;
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcCommitScene(scene);
    for (const uint64_t size : sizes) {
        std::vector<float> segments(6 * size);
        if (!read(file, segments.data(), segments.size())) return 1;
        size_t hits = intersect(scene, segments);
        std::vector<double> times;
        for (uint64_t run = 0; run < runs; run++) {
            const double start = on_cpu();
            hits = intersect(scene, segments);
            times.push_back(on_cpu() - start);
        }
        std::sort(times.begin(), times.end());
        fprintf(stderr, "segments: Embree meets %zu of %zu\n", hits, size_t(size));
        printf("%.3f\n", 1e9 * times[times.size() / 2] / double(size));
    }
    return 0;
}
