#include <sluice/camera_motion.h>

#include "base/checked.h"
#include "base/struct_size.h"

#include <math.h>
#include <string.h>

/* A camera that moves less than this over all frames stands still. */
#define STILL_METERS 0.004
#define STILL_RADIANS 0.004

#define MOST_SPEEDING_UP 1.0 /* most way by acceleration / way by the present speed */
#define JUMP 4.0             /* least length of a jump / length of all other steps together */
#define LONGEST_STEP 0.25    /* seconds between two frames */
#define MOST_TURN 1.5        /* radians: the prediction must still overlap the picture */
#define DEFAULT_SHRINK 4u

enum { FRAMES = SLUICE_CAMERA_FRAMES, MIDDLE = FRAMES / 2, NEWEST = FRAMES - 1 };

struct vector {
    double x, y, z;
};

static struct vector load(const double v[3])
{
    return (struct vector){v[0], v[1], v[2]};
}

static struct vector add(struct vector a, struct vector b)
{
    return (struct vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

static struct vector scale(struct vector a, double s)
{
    return (struct vector){a.x * s, a.y * s, a.z * s};
}

static struct vector subtract(struct vector a, struct vector b)
{
    return add(a, scale(b, -1.0));
}

static double dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct vector cross(struct vector a, struct vector b)
{
    return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double length_of(struct vector a)
{
    return sqrt(dot(a, a));
}

/* Matrices ------------------------------------------------------------------------------------- */

/* Returns an axis of the camera in world space. */
static struct vector axis_of(const float *m, uint32_t row)
{
    return (struct vector){m[row], m[4 + row], m[8 + row]};
}

static struct vector eye_of(const float *m)
{
    struct vector eye = scale(axis_of(m, 0), -(double)m[12]);
    eye = subtract(eye, scale(axis_of(m, 1), m[13]));
    return subtract(eye, scale(axis_of(m, 2), m[14]));
}

/* True if a matrix is a rotation or reflection, and a translation. False for NaN. */
static bool is_rigid(const float *m)
{
    const double slack = 1e-3;
    for (uint32_t i = 0; i < 3; i++) {
        struct vector axis = axis_of(m, i);
        if (!(fabs(dot(axis, axis) - 1.0) < slack) ||
            !(fabs(dot(axis, axis_of(m, (i + 1) % 3))) < slack) || !isfinite(m[12 + i]))
            return false;
    }
    return m[3] == 0.0f && m[7] == 0.0f && m[11] == 0.0f && m[15] == 1.0f;
}

static bool write_matrix(const struct vector axes[3], struct vector eye, float *m)
{
    bool finite = true;
    for (uint32_t i = 0; i < 3; i++) {
        m[i] = (float)axes[i].x;
        m[4 + i] = (float)axes[i].y;
        m[8 + i] = (float)axes[i].z;
        m[12 + i] = (float)-dot(axes[i], eye);
        m[4 * i + 3] = 0.0f;
        finite = finite && isfinite(m[12 + i]);
    }
    m[15] = 1.0f;
    return finite;
}

SluiceResult sluiceAddCameraFrame(SluiceCameraMotion *pMotion, const float *pViewMatrix,
                                  double seconds)
{
    SluiceCameraMotion *motion = pMotion;
    if (!motion || !pViewMatrix)
        return SLUICE_ERROR_NULL_POINTER;
    if (!is_rigid(pViewMatrix) || !isfinite(seconds)) {
        motion->count = 0;
        return SLUICE_ERROR_INVALID_ARGUMENT;
    }
    double step = seconds - motion->times[NEWEST];
    if (motion->count > 0 && !(step > 0.0 && step <= LONGEST_STEP))
        motion->count = 0;
    memmove(motion->times, motion->times + 1, NEWEST * sizeof *motion->times);
    memmove(motion->eyes, motion->eyes + 1, NEWEST * sizeof *motion->eyes);
    memmove(motion->axes, motion->axes + 1, NEWEST * sizeof *motion->axes);
    struct vector eye = eye_of(pViewMatrix), axis = axis_of(pViewMatrix, 2);
    memcpy(motion->eyes[NEWEST], &eye, sizeof motion->eyes[NEWEST]);
    memcpy(motion->axes[NEWEST], &axis, sizeof motion->axes[NEWEST]);
    memcpy(motion->viewMatrix, pViewMatrix, sizeof motion->viewMatrix);
    motion->times[NEWEST] = seconds;
    motion->count += motion->count < FRAMES;
    return SLUICE_SUCCESS;
}

/* Prediction ----------------------------------------------------------------------------------- */

/* Speed and its change at the newest of some points in time: exact for parabolas. */
static void fit(const double points[FRAMES][3], const double times[FRAMES], struct vector *speed,
                struct vector *change)
{
    double before = times[MIDDLE] - times[0], after = times[NEWEST] - times[MIDDLE];
    struct vector middle = load(points[MIDDLE]);
    struct vector old_speed = scale(subtract(middle, load(points[0])), 1.0 / before);
    struct vector new_speed = scale(subtract(load(points[NEWEST]), middle), 1.0 / after);
    *change = scale(subtract(new_speed, old_speed), 2.0 / (before + after));
    *speed = add(new_speed, scale(*change, after / 2.0));
}

/* True if one step is far longer than all others together. */
static bool has_jump(const double points[FRAMES][3], double still)
{
    double longest = 0.0, all = 0.0;
    for (int i = 0; i < NEWEST; i++) {
        double step = length_of(subtract(load(points[i + 1]), load(points[i])));
        longest = fmax(longest, step);
        all += step;
    }
    return longest > still && longest > JUMP * (all - longest);
}

/* Predicts the way from the newest point on. */
static struct vector way_ahead(const double points[FRAMES][3], const double times[FRAMES],
                               double seconds, double still)
{
    const struct vector none = {0.0, 0.0, 0.0};
    struct vector speed, change;
    fit(points, times, &speed, &change);
    double along = dot(speed, change);
    if (along < 0.0) /* slows down, to a halt */
        seconds = fmin(seconds, dot(speed, speed) / -along);
    struct vector even = scale(speed, seconds), bend = scale(change, 0.5 * seconds * seconds);
    double most = MOST_SPEEDING_UP * length_of(even), length = length_of(bend);
    if (length > most)
        bend = scale(bend, most / length);
    struct vector way = add(even, bend);
    double far = length_of(way);
    return isfinite(far) && far > still ? way : none;
}

/* Turns all axes so that the last one moves by `arc`, in radians, at a right angle to itself. */
static void turn(struct vector axes[3], struct vector arc)
{
    arc = subtract(arc, scale(axes[2], dot(arc, axes[2])));
    double angle = length_of(arc);
    if (!(angle > 0.0))
        return;
    struct vector around = scale(cross(axes[2], arc), 1.0 / angle);
    angle = fmin(angle, MOST_TURN);
    for (uint32_t i = 0; i < 3; i++) { /* Rodrigues' formula */
        struct vector v = axes[i];
        axes[i] =
            add(scale(v, cos(angle)), add(scale(cross(around, v), sin(angle)),
                                          scale(around, dot(around, v) * (1.0 - cos(angle)))));
    }
}

/* Predicts the view matrix. False: the camera stands still, or cannot be predicted. */
static bool look_ahead(const SluiceCameraMotion *motion, double seconds, float *matrix)
{
    memcpy(matrix, motion->viewMatrix, sizeof motion->viewMatrix);
    if (motion->count < FRAMES || !(seconds > 0.0))
        return false;
    if (has_jump(motion->eyes, STILL_METERS) || has_jump(motion->axes, STILL_RADIANS))
        return false;
    struct vector way = way_ahead(motion->eyes, motion->times, seconds, STILL_METERS);
    struct vector arc = way_ahead(motion->axes, motion->times, seconds, STILL_RADIANS);
    if (!(length_of(way) > 0.0) && !(length_of(arc) > 0.0))
        return false;
    struct vector axes[3] = {axis_of(matrix, 0), axis_of(matrix, 1), axis_of(matrix, 2)};
    turn(axes, arc);
    if (write_matrix(axes, add(load(motion->eyes[NEWEST]), way), matrix))
        return true;
    memcpy(matrix, motion->viewMatrix, sizeof motion->viewMatrix);
    return false;
}

SluiceResult sluicePredictCamera(const SluiceCameraMotion *pMotion,
                                 const SluiceLookAheadInfo *pInfo, SluiceLookAhead *pLookAhead)
{
    if (!pMotion || !pInfo || !pLookAhead)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceLookAheadInfo info = {.structSize = sizeof info};
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceLookAheadInfo), &info, pInfo, NULL);
    if (result == SLUICE_SUCCESS)
        result = slc_struct_check(SLC_STRUCT(SluiceLookAhead), pLookAhead, NULL);
    if (result == SLUICE_SUCCESS && (!info.pictureWidth || !info.pictureHeight))
        result = SLUICE_ERROR_INVALID_ARGUMENT;
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t shrink = info.shrink ? info.shrink : DEFAULT_SHRINK;
    SluiceLookAhead out = {.structSize = sizeof out,
                           .width = slc_div_up_u32(info.pictureWidth, shrink),
                           .height = slc_div_up_u32(info.pictureHeight, shrink),
                           .lodBias = -log2f((float)shrink)};
    /* A camera that turns meets the near views first, and a far prediction may have skipped them.
     */
    out.seconds = info.frameIndex % 2 ? 0.5 * info.seconds : info.seconds;
    out.draw = look_ahead(pMotion, out.seconds, out.viewMatrix);
    slc_struct_write(SLC_STRUCT(SluiceLookAhead), pLookAhead, &out);
    return SLUICE_SUCCESS;
}
