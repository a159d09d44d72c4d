/* trig_kernel.h - sine and cosine of |x| <= pi/4: minimax polynomials with the classic fdlibm coefficients. Only
 * + - * so every IEEE machine gives the same bits, and loops over them can be vectorised. */
#ifndef FF_TRIG_KERNEL_H
#define FF_TRIG_KERNEL_H

static inline double ff_kernel_sin(double x)
{
    double z = x * x;
    double r = 8.33333333332248946124e-03 +
               z * (-1.98412698298579493134e-04 +
                    z * (2.75573137070700676789e-06 +
                         z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)));
    return x + x * z * (-1.66666666666666324348e-01 + z * r);
}

static inline double ff_kernel_cos(double x)
{
    double z = x * x;
    double r = z * (4.16666666666666019037e-02 +
                    z * (-1.38888888888741095749e-03 +
                         z * (2.48015872894767294178e-05 +
                              z * (-2.75573143513906633035e-07 +
                                   z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    return 1.0 - (0.5 * z - z * r);
}

#endif
