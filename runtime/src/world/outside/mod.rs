//! Models of devices that users connect.

pub(crate) mod echo;
pub(crate) mod kstep_analog;
pub(crate) mod modbus;
pub(crate) mod quadrature;
pub(crate) mod rc;
pub(crate) mod resolver;
pub(crate) mod spi;
pub(crate) mod wire;

#[cfg(test)]
pub(crate) mod testing;
