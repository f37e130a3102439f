#include "camera_path.h"

#include <math.h>
#include <string.h>

/** Right-handed axes of length 1, their former lengths, and the camera's position. */
struct pose {
    double axes[3][3], lengths[3], eye[3];
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/** Scales to length 1 and returns the former length. Vectors of length 0 stay as they are. */
static double normalize(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3 && length > 0.0; i++)
        v[i] /= length;
    return length;
}

/** Splits a matrix. The length of x is negative if the matrix mirrors. */
static struct pose pose_of(const float m[12])
{
    struct pose p;
    double yz[3];
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < 3; i++)
            p.axes[axis][i] = m[4 * i + axis];
        p.lengths[axis] = normalize(p.axes[axis]);
        p.eye[axis] = m[4 * axis + 3];
    }
    cross(p.axes[1], p.axes[2], yz);
    if (dot(yz, p.axes[0]) < 0.0) {
        p.lengths[0] = -p.lengths[0];
        for (int i = 0; i < 3; i++)
            p.axes[0][i] = -p.axes[0][i];
    }
    return p;
}

static void write_matrix(const struct pose *p, float m[12])
{
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < 3; i++)
            m[4 * i + axis] = (float)(p->lengths[axis] * p->axes[axis][i]);
        m[4 * axis + 3] = (float)p->eye[axis];
    }
}

void camera_look_at(const struct camera_view *view, const float like[12], float matrix[12])
{
    const struct pose old = pose_of(like);
    struct pose p = old;
    for (int i = 0; i < 3; i++) {
        p.eye[i] = view->eye[i];
        p.axes[2][i] = (double)view->look[i] - view->eye[i];
        p.axes[1][i] = view->has_up ? view->up[i] : old.axes[1][i];
    }
    normalize(p.axes[2]);
    normalize(p.axes[1]);
    cross(p.axes[1], p.axes[2], p.axes[0]);
    if (normalize(p.axes[0]) < 1e-6) { /* the camera looks along the up vector */
        cross(old.axes[fabs(dot(old.axes[0], p.axes[2])) < 0.9 ? 0 : 1], p.axes[2], p.axes[1]);
        normalize(p.axes[1]);
        cross(p.axes[1], p.axes[2], p.axes[0]);
        normalize(p.axes[0]);
    }
    cross(p.axes[2], p.axes[0], p.axes[1]);
    write_matrix(&p, matrix);
}

/** Quaternion w, x, y, z of the rotation that takes x, y, z to the axes. Finds the largest
 * component first (Shepperd, "Quaternion from Rotation Matrix", 1978). */
static void quaternion_of(const struct pose *p, double q[4])
{
    double squares[4] = {1.0, 1.0, 1.0, 1.0};
    int largest = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++)
            squares[k] += (k == 0 || k == i + 1 ? 1.0 : -1.0) * p->axes[i][i];
    for (int k = 1; k < 4; k++)
        largest = squares[k] > squares[largest] ? k : largest;
    const double scale = 0.5 / sqrt(squares[largest]);
    q[largest] = 0.5 * sqrt(squares[largest]);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        if (largest == 0)
            q[i + 1] = scale * (p->axes[j][k] - p->axes[k][j]);
        else if (largest == i + 1)
            q[0] = scale * (p->axes[j][k] - p->axes[k][j]);
        else
            q[i + 1] = scale * (p->axes[i][largest - 1] + p->axes[largest - 1][i]);
    }
}

static void set_axes(const double q[4], struct pose *p)
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double axes[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                               {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                               {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(p->axes, axes, sizeof axes);
}

void camera_between(const float from[12], const float to[12], float share, float matrix[12])
{
    const struct pose a = pose_of(from);
    struct pose p = pose_of(to);
    double q[4], r[4], cosine = 0.0;
    quaternion_of(&a, q);
    quaternion_of(&p, r);
    for (int i = 0; i < 4; i++)
        cosine += q[i] * r[i];
    const double sign = cosine < 0.0 ? -1.0 : 1.0, angle = acos(fmin(sign * cosine, 1.0));
    const double sine = sin(angle);
    const double first = sine > 1e-6 ? sin((1.0 - share) * angle) / sine : 1.0 - share;
    const double second = sine > 1e-6 ? sin(share * angle) / sine : share;
    double length = 0.0;
    for (int i = 0; i < 4; i++) {
        q[i] = first * q[i] + second * sign * r[i];
        length += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(length);
    set_axes(q, &p);
    for (int i = 0; i < 3; i++)
        p.eye[i] = (1.0 - share) * a.eye[i] + share * p.eye[i];
    write_matrix(&p, matrix);
}
