#include "core/math/functions.h"

#include <sleef.h>

namespace dispersa {

double Sin(double x_rad) { return Sleef_finz_sind1_u10purecfma(x_rad); }
double Cos(double x_rad) { return Sleef_finz_cosd1_u10purecfma(x_rad); }
SinCos SineCosine(double x_rad) {
  const auto both = Sleef_finz_sincosd1_u10purecfma(x_rad);
  return {both.x, both.y};
}
double Asin(double x) { return Sleef_finz_asind1_u10purecfma(x); }
double Atan(double x) { return Sleef_finz_atand1_u10purecfma(x); }
double Atan2(double y, double x) { return Sleef_finz_atan2d1_u10purecfma(y, x); }
double Exp(double x) { return Sleef_finz_expd1_u10purecfma(x); }
double Log(double x) { return Sleef_finz_logd1_u10purecfma(x); }
double Log10(double x) { return Sleef_finz_log10d1_u10purecfma(x); }
double Pow(double x, double y) { return Sleef_finz_powd1_u10purecfma(x, y); }

}  // namespace dispersa
