//! The background service of the UART.

use std::collections::VecDeque;

use kmotiondef::variables::{P_RS232_TX_IN, P_RS232_TX_OUT};
use vm::memory::GuestMemory;

use crate::views::TypedAccess;
use chips::uart::Uart;

/// The serial service, which a program starts.
#[derive(Clone, Debug, Default)]
pub(crate) struct SerialService {
    pub(crate) is_on: bool,
    /// Replies for which the transmit ring has no room yet.
    pub(crate) replies: VecDeque<u8>,
}

impl SerialService {
    /// Returns whether characters are still to be sent or received.
    pub(crate) fn is_busy(&self, memory: &GuestMemory, uart: &Uart) -> bool {
        self.is_on
            && (uart.is_receiving()
                || !self.replies.is_empty()
                || memory.get(P_RS232_TX_OUT) != memory.get(P_RS232_TX_IN))
    }
}
