// First hits of segments by Embree's robust mode: reads a mesh and sets of segments from standard input, writes the seconds and the hits of each set.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <vector>
#include <xmmintrin.h>

static const int RUNS = 5;

static double seconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

template <class T> static bool read(T *to, size_t count) { return fread(to, sizeof(T), count, stdin) == count; }

static int hits(RTCScene scene, const std::vector<float> &segments) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    int hits = 0;
    for (size_t i = 0; i < segments.size(); i += 6) {
        const float *s = &segments[i];
        RTCRayHit hit = {};
        hit.ray.org_x = s[0], hit.ray.org_y = s[1], hit.ray.org_z = s[2];
        hit.ray.dir_x = s[3], hit.ray.dir_y = s[4], hit.ray.dir_z = s[5];
        hit.ray.tfar = 1, hit.ray.mask = -1;
        hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene, &context, &hit);
        hits += hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

int main() {
    // As its manual asks.
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    uint32_t vertices, faces, sets;
    if (!read(&vertices, 1) || !read(&faces, 1)) return 1;
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void *points = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, vertices);
    void *corners = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, faces);
    if (!read((float *)points, 3 * size_t(vertices)) || !read((uint32_t *)corners, 3 * size_t(faces))) return 1;
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcCommitScene(scene);
    if (!read(&sets, 1)) return 1;
    while (sets-- > 0) {
        uint32_t count;
        if (!read(&count, 1)) return 1;
        std::vector<float> segments(6 * size_t(count));
        if (!read(segments.data(), segments.size())) return 1;
        std::vector<double> times;
        int met = 0;
        for (int run = 0; run < RUNS; run++) {
            double start = seconds();
            met = hits(scene, segments);
            times.push_back(seconds() - start);
        }
        std::sort(times.begin(), times.end());
        printf("%.9f %d\n", times[RUNS / 2], met);
    }
}
