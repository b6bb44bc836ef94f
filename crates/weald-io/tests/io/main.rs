//! Raster files: what is written is read again, by us and by the programs of others; damaged files are refused.

mod array_clients;
mod arrays;
mod clients;
mod damaged_files;
mod exr_raw_asc;
mod foreign_clients;
mod formats;
mod rasters;
mod rows;
mod written;
