#pragma once
// Messages of ROS 2's package sensor_msgs: pictures and clouds of points.

#include "ros/messages/sensor_msgs.h"

namespace gloam::sensor_msgs {

struct Image {
  std_msgs::Header header;  ///< frame: z forward, x right, y down
  uint32_t height = 0, width = 0;
  std::string encoding;      ///< "rgb8", "32FC1", …
  uint8_t is_bigendian = 0;  ///< 0 or 1
  uint32_t step = 0;         ///< bytes of a row
  Bytes data;                ///< step * height bytes
  GLOAM_MESSAGE(Image, header, height, width, encoding, is_bigendian, step, data)
};

struct CompressedImage {
  std_msgs::Header header;
  std::string format;  ///< "jpeg", "png", …
  Bytes data;          ///< a file of that format
  GLOAM_MESSAGE(CompressedImage, header, format, data)
};

/// A rectangle of a picture [px]; all zero = the whole picture.
struct RegionOfInterest {
  uint32_t x_offset = 0, y_offset = 0, height = 0, width = 0;
  bool do_rectify = false;
  GLOAM_MESSAGE(RegionOfInterest, x_offset, y_offset, height, width, do_rectify)
};

struct CameraInfo {
  std_msgs::Header header;
  uint32_t height = 0, width = 0;
  std::string distortion_model;   ///< "plumb_bob", "rational_polynomial", "equidistant"
  std::vector<double> d;          ///< of the distortion model
  std::array<double, 9> k = {};   ///< intrinsic matrix, row-major [px]
  std::array<double, 9> r = {};   ///< rectification, row-major
  std::array<double, 12> p = {};  ///< projection, 3x4, row-major [px]
  uint32_t binning_x = 0, binning_y = 0;
  RegionOfInterest roi;
  GLOAM_MESSAGE(CameraInfo, header, height, width, distortion_model, d, k, r, p, binning_x,
                binning_y, roi)
};

struct PointField {
  std::string name;      ///< "x", "intensity", …
  uint32_t offset = 0;   ///< bytes from the start of a point
  uint8_t datatype = 0;  ///< a constant below
  uint32_t count = 1;
  GLOAM_CONSTANTS(uint8, INT8 = 1, UINT8 = 2, INT16 = 3, UINT16 = 4, INT32 = 5, UINT32 = 6,
                  FLOAT32 = 7, FLOAT64 = 8)
  GLOAM_MESSAGE(PointField, name, offset, datatype, count)
};

struct PointCloud2 {
  std_msgs::Header header;
  uint32_t height = 0, width = 0;  ///< height 1 = points without an order
  std::vector<PointField> fields;
  bool is_bigendian = false;
  uint32_t point_step = 0, row_step = 0;  ///< bytes
  Bytes data;                             ///< row_step * height bytes
  bool is_dense = false;                  ///< no point has a number that is not finite
  GLOAM_MESSAGE(PointCloud2, header, height, width, fields, is_bigendian, point_step, row_step,
                data, is_dense)
};

}  // namespace gloam::sensor_msgs
