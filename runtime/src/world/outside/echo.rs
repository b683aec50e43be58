//! A device on the UART that echoes the characters it receives.

use kmotiondef::Cycles;

use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::world::attached::Settings;

/// An echo.
#[derive(Clone, Debug)]
pub(crate) struct Echo;

impl Echo {
    /// It has no settings.
    pub(crate) fn new(_: &mut Settings<'_>) -> Result<Self, String> {
        Ok(Self)
    }
}

impl AttachedDevice for Echo {
    fn sent(&mut self, byte: u8, at: Cycles, outside: &mut DeviceContext<'_>) {
        outside.uart.queue_bytes(&[byte], at);
    }
}

#[cfg(test)]
mod tests {
    use crate::world::outside::testing::{Bench, us};

    #[test]
    fn what_is_sent_comes_back() {
        let mut bench = Bench::new("echo");
        bench.uart.set_divisor(8);
        bench.uart.status(us(0));
        bench.sent(b'x', 100);
        assert_eq!(bench.uart.read(us(2000)), b'x');
    }
}
